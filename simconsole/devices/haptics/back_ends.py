"""The interface to the wheel's motor: SDL first, evdev where SDL finds none, or the one that the profile names."""

import os

from simconsole.devices.force_feedback.motor import HapticPort
from simconsole.devices.haptics.driver_settings import RestoringPort, read_settings
from simconsole.devices.haptics.evdev_haptics import open_evdev
from simconsole.devices.haptics.sdl_haptics import open_haptics
from simconsole.devices.sources.event_nodes import effect_slots, open_node, stop_effects
from simconsole.profiles.force_feedback import ForceFeedback
from simconsole.values.errors import DeviceError


def open_motor(instance_id: int, identity: tuple[int, int], force: ForceFeedback) -> HapticPort:
    """Open the motor of a wheel; the port says why where there is no force.

    The first act is to stop every effect that is on it, whoever left it running. Where its driver tells gain and
    autocentre, they are put back as they were when the motor is closed; where not, it is left as the profile says.

    Args:
        instance_id: SDL's, of the wheel's open joystick.
        identity: Its USB vendor and product id.
        force: The cockpit's; its `back_end` may name one.
    """
    stop_leftover_effects(identity)
    before = read_settings(identity)
    port = _opened(instance_id, identity, force)
    return RestoringPort(port, before) if before and port.capability.constant else port


def stop_leftover_effects(identity: tuple[int, int]) -> None:
    """Stop every effect of a wheel; SDL's own StopAll knows only those of its process.

    Nothing where there is no access: the kernel takes away the effects of a process that ends, however it does.
    """
    try:
        descriptor = open_node(identity)
    except DeviceError:
        return
    try:
        stop_effects(descriptor, effect_slots(descriptor))
    except OSError:
        return
    finally:
        os.close(descriptor)


def _opened(instance_id: int, identity: tuple[int, int], force: ForceFeedback) -> HapticPort:
    if force.back_end == "evdev":
        return open_evdev(identity, force)
    port = open_haptics(instance_id, force)
    if port.capability.constant or force.back_end == "sdl":
        return port
    other = open_evdev(identity, force)
    return other if other.capability.constant else port
