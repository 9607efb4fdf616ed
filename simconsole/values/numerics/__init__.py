"""Numbers that are the same on every machine: rounding, and functions of whole arrays."""
