"""Faults on a schedule, and the layers they act through."""
