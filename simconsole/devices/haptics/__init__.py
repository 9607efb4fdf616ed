"""The wheel's motor through SDL and evdev, and the watchdog that stops it."""
