"""Joysticks, real and virtual, through SDL."""
