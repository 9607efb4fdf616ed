"""The keyboard as a driver's device: which keys are held, as one mask that the window's process reports to the cockpit.

The window owns the keyboard; the cockpit's keyboard source turns the mask into axes. Both meet here.
"""

from enum import IntFlag


class Key(IntFlag):
    """Keys held now. The mask is a small whole number, so a float64 or an int64 slot holds it exactly."""

    STEER_LEFT = 1
    STEER_RIGHT = 2
    THROTTLE = 4
    BRAKE = 8
    CLUTCH = 16
    HANDBRAKE = 32
    GEAR_UP = 64
    GEAR_DOWN = 128
    AUTONOMOUS = 256
    MANUAL = 512
    EMERGENCY_STOP = 1024
    RESET = 2048
    INDICATOR_LEFT = 4096
    INDICATOR_RIGHT = 8192
    MARK = 16384
    HAZARD = 32768
    PAUSE = 65536
    RESTART = 131072
    TAKEOVER = 262144
    SHARED = 524288
    FAULT = 1048576
    END = 2097152  # ends the drive, as closing the window does
    HORN = 4194304
