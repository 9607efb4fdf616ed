"""A hardware-in-the-loop driving-simulator console. Start at docs/tick.md."""

__version__ = "0.1.0"
