"""Figures of a recorded drive: pure."""
