"""Inputs without a joystick: keyboard, scripts, traces: pure."""
