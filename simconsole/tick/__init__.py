"""The pure middle: advance() and its assembly, the one place that knows the order of a tick."""
