"""Many vehicles at once, compiled."""
