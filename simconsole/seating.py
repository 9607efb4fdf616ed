"""Who sits in the cockpit: the device source of a session, and the simulated person where one drives."""

from collections.abc import Callable
from contextlib import ExitStack
from typing import NamedTuple

from simconsole.assembly import ResolvedSession
from simconsole.errors import ProfileError
from simconsole.pipeline import Console
from simconsole.ports import DeviceSource, NobodySeated, Seat
from simconsole.rows import Snapshot


class Seating(NamedTuple):
    """An opened cockpit."""

    devices: DeviceSource
    seat: Seat | None = None
    finished: Callable[[Snapshot], bool] = lambda snapshot: False


def open_seating(
    resolved: ResolvedSession, console: Console, stack: ExitStack, keys: Callable[[], tuple[int, int]] | None = None
) -> Seating:
    """Open the cockpit that the session names; `stack` closes it.

    Args:
        resolved: the session.
        console: the console it drives.
        stack: closes what is opened here.
        keys: (mask of held keys, age in ticks) from the window's process; None without a window.

    Raises:
        ProfileError: the keyboard drives but there is no window.
        DeviceError: a device is missing or in a mode that cannot drive.
    """
    driver = resolved.session.devices.driver
    if driver == "none":
        return Seating(NobodySeated())
    if driver == "virtual":
        return _open_person(resolved, console, stack)
    if driver == "keyboard" and keys is None:
        raise ProfileError("devices.driver: value keyboard: needs a window, so not with --headless or hud: false")
    from simconsole.devices.source import open_source

    devices = open_source(driver, resolved.cockpit, tick_hz=console.tick_hz, keys=keys)
    stack.callback(devices.close)
    return Seating(devices)


def _open_person(resolved: ResolvedSession, console: Console, stack: ExitStack) -> Seating:
    from simconsole.devices.person import SimulatedPerson
    from simconsole.devices.sdl import SdlSource
    from simconsole.devices.settings import settings
    from simconsole.devices.virtual_cockpit import VirtualCockpit

    plan = resolved.session.devices.person
    if plan is None:
        raise ProfileError("devices.person: value missing: a plan, where devices.driver is virtual")
    cockpit = VirtualCockpit(resolved.cockpit)
    stack.callback(cockpit.close)
    devices = SdlSource(resolved.cockpit)
    stack.callback(devices.close)
    person = SimulatedPerson(plan, cockpit, settings(resolved.cockpit, console.tick_hz), tick_hz=console.tick_hz)
    return Seating(devices, person, lambda snapshot: person.finished)
