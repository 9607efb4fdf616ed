"""The same inputs, one thing changed."""
