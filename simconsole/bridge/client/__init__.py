"""A rosbridge client."""
