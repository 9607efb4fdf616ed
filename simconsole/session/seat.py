"""Opens the cockpit of a session: its device source, and the simulated person where one drives."""

import sys
import time
from collections.abc import Callable
from contextlib import ExitStack
from typing import TYPE_CHECKING, NamedTuple

from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.force_feedback import ForceFeedback
from simconsole.profiles.person import ROUTE_DRIVER, PersonPlan
from simconsole.tick.advance import Console
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.errors import DeviceError, ProfileError
from simconsole.values.host.jit import compiled
from simconsole.values.protocols import DeviceIdentity, DeviceSource, NobodySeated, Output, Seat
from simconsole.values.state_vector import Snapshot
from simconsole.world.kinds.worlds import open_world

if TYPE_CHECKING:
    from simconsole.devices.force_feedback.motor import HapticPort
    from simconsole.devices.sources.sdl_source import SdlSource
    from simconsole.drivers.simulated_person.guidance import Guidance
    from simconsole.world.rules.speed_advice import Advice


class OpenedCockpit(NamedTuple):
    """An opened cockpit."""

    devices: DeviceSource
    seat: Seat | None = None
    outputs: tuple[Output, ...] = ()
    finished: Callable[[Snapshot], bool] = lambda snapshot: False
    identities: tuple[DeviceIdentity, ...] = ()
    """Of the devices that a person or a simulated one works; none of a trace, a script or the keyboard."""


def look_for_devices(resolved: ResolvedSession) -> None:
    """Open and close the devices that the session names: a missing one is told before anything is compiled.

    Raises:
        DeviceError: a device is missing, in a mode that cannot drive, or would steer the car wrong.
    """
    if resolved.session.devices.driver == "sdl":
        from simconsole.devices.sources.kernel_limits import problems, wheel_limits
        from simconsole.devices.sources.sdl_source import SdlSource

        SdlSource(resolved.cockpit).close()
        wrong = problems(wheel_limits(resolved.cockpit), resolved.cockpit)
        if wrong:
            raise DeviceError(f"{resolved.cockpit.title}: {wrong[0]}")


def open_cockpit(
    resolved: ResolvedSession,
    console: Console,
    stack: ExitStack,
    keys: Callable[[], tuple[int, int]] | None = None,
    advice: "Callable[[int], Advice] | None" = None,
) -> OpenedCockpit:
    """Open the cockpit that the session names; `stack` closes it.

    Args:
        resolved: the session.
        console: the console it drives.
        stack: closes what is opened here.
        keys: (mask of held keys, age in ticks) from the window's process; None without a window.
        advice: the display's speed advice at a time of the drive (ns), for a simulated person; None: it has none.

    Raises:
        ProfileError: the keyboard drives but there is no window.
        DeviceError: a device is missing or in a mode that cannot drive.
    """
    driver = resolved.session.devices.driver
    if driver == "none":
        return OpenedCockpit(NobodySeated())
    if driver == "virtual":
        return _open_person(resolved, console, stack, advice)
    if driver == "keyboard" and keys is None:
        raise ProfileError("devices.driver: value keyboard: needs a window, so not with --headless or hud: false")
    from simconsole.devices.calibration.cockpit_settings import cockpit_settings
    from simconsole.devices.sources.sdl_source import SdlSource
    from simconsole.devices.sources.source_registry import open_source
    from simconsole.devices.synthetic.keyboard import KeyboardSource
    from simconsole.devices.synthetic.steering_assistance import AssistedSource, assistance_of

    devices = open_source(driver, resolved.cockpit, tick_hz=console.tick_hz, keys=keys)
    stack.callback(devices.close)
    if isinstance(devices, KeyboardSource):
        return OpenedCockpit(devices, outputs=(devices,))
    if not isinstance(devices, SdlSource):
        return OpenedCockpit(devices)
    identities = devices.identities()
    assistance = assistance_of(resolved.cockpit.wheel)
    if assistance is not None:
        settings = cockpit_settings(resolved.cockpit, console.tick_hz)
        assisted = AssistedSource(devices, settings, assistance, tick_hz=console.tick_hz)
        return OpenedCockpit(assisted, outputs=(assisted,), identities=identities)
    if resolved.cockpit.force_feedback is None:
        _say(f"no force feedback: {resolved.cockpit.title} has none; everything else works")
        return OpenedCockpit(devices, identities=identities)
    cockpit = _with_motor(devices, resolved.cockpit, resolved.cockpit.force_feedback, stack)
    return cockpit._replace(identities=identities)


def _say(line: str) -> None:
    print(f"simconsole: {line}", file=sys.stderr, flush=True)


def _with_motor(devices: "SdlSource", cockpit: CockpitProfile, force: ForceFeedback, stack: ExitStack) -> OpenedCockpit:
    """Add the wheel's motor; without one everything else works, and a line says so."""
    from simconsole.devices.force_feedback.motor import MotorisedSource, NoHaptics, WheelMotor
    from simconsole.devices.force_feedback.servo_range import servo_refusal
    from simconsole.devices.haptics.back_ends import open_motor
    from simconsole.devices.haptics.watchdog_client import open_watchdog, with_watchdog
    from simconsole.devices.sources.kernel_limits import notes, wheel_limits

    wheel = {"id": devices.instance_id("wheel")}
    identity = next((role.vendor_id, role.product_id) for role in cockpit.roles if role.role == "wheel")
    for line in notes(wheel_limits(cockpit)):
        _say(line)
    watchdog = open_watchdog(identity, _say)
    if watchdog is not None:
        stack.callback(watchdog.close)

    def opened() -> "HapticPort":
        number = wheel["id"]
        if number is None:
            return NoHaptics("the wheel is unplugged")
        return with_watchdog(open_motor(number, identity, force), watchdog)

    def replugged() -> "HapticPort | None":
        now = devices.instance_id("wheel")
        if now == wheel["id"]:
            return None
        wheel["id"] = now
        return opened()

    motor = WheelMotor(opened(), force, lambda snapshot: time.monotonic(), _say)
    stack.callback(motor.close)
    refusal = servo_refusal(force)
    if refusal is not None:
        _say(f"autonomy is refused with this wheel: {refusal}")
    return OpenedCockpit(MotorisedSource(devices, motor, replugged, refusal is None), outputs=(motor,))


def _open_person(
    resolved: ResolvedSession, console: Console, stack: ExitStack, advice: "Callable[[int], Advice] | None"
) -> OpenedCockpit:
    from simconsole.devices.calibration.cockpit_settings import cockpit_settings
    from simconsole.devices.force_feedback.motor import MotorisedSource, SimulatedWheelPort, WheelMotor
    from simconsole.devices.force_feedback.simulated_wheel import SimulatedWheel, step_wheel
    from simconsole.devices.sources.sdl_source import SdlSource
    from simconsole.devices.sources.virtual_cockpit import VirtualCockpit
    from simconsole.drivers.cockpit.simulated_person import SimulatedPerson
    from simconsole.drivers.simulated_person.situation import ahead_in, with_display

    plan, guidance = _plan(resolved, console.tick_hz)
    look = ahead_in if advice is None else with_display(advice)
    cockpit = VirtualCockpit(resolved.cockpit)
    stack.callback(cockpit.close)
    devices = SdlSource(resolved.cockpit, cockpit.has)  # another person may sit at devices that are alike
    stack.callback(devices.close)
    numbers, tick_hz = cockpit_settings(resolved.cockpit, console.tick_hz), console.tick_hz
    force = resolved.cockpit.force_feedback
    if force is None:
        person = SimulatedPerson(plan, cockpit, numbers, tick_hz=tick_hz, guidance=guidance, look=look)
        return OpenedCockpit(
            devices, person, finished=lambda snapshot: person.finished, identities=devices.identities()
        )
    wheel = SimulatedWheel(force, resolved.cockpit.wheel.lock_to_lock_deg, tick_hz=tick_hz, step=compiled(step_wheel))
    person = SimulatedPerson(plan, cockpit, numbers, tick_hz=tick_hz, wheel=wheel, guidance=guidance, look=look)
    motor = WheelMotor(SimulatedWheelPort(wheel), force, lambda snapshot: snapshot.t_s)
    stack.callback(motor.close)
    return OpenedCockpit(
        MotorisedSource(devices, motor, lambda: None),
        person,
        (motor,),
        finished=lambda snapshot: person.finished,
        identities=devices.identities(),
    )


def _plan(resolved: ResolvedSession, tick_hz: int) -> "tuple[PersonPlan, Guidance | None]":
    """Return what the simulated person does, and where they go; None: straight on.

    Raises:
        ProfileError: they should drive along a route, and there is none.
    """
    from simconsole.drivers.simulated_person.along_route import AlongRoute

    plan = resolved.session.devices.person or ROUTE_DRIVER
    if plan.along == "straight":
        return plan, None
    if resolved.world is None:
        raise ProfileError("devices.person.along: value route: straight, without environment.world")
    return plan, AlongRoute(plan, open_world(resolved.world).route, tick_hz)
