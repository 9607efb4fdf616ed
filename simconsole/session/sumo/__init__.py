"""SUMO beside a paced drive: a worker of its own, and what the core sees of it."""
