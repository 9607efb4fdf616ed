"""What `simconsole devices` does: list, check and record, as functions that return plain values."""

import time
from collections.abc import Callable
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import Any, Final, Self

from simconsole.devices.calibration.cockpit_check import CockpitCheck
from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.calibration.cockpit_text import cockpit_lines
from simconsole.devices.sources import kernel_limits, sdl_runtime
from simconsole.devices.sources.kernel_limits import KernelLimits, wheel_limits
from simconsole.devices.sources.sdl_source import SdlSource, connected_joysticks, is_device
from simconsole.devices.sources.trace_files import TraceWriter
from simconsole.devices.sources.virtual_cockpit import VirtualCockpit
from simconsole.devices.synthetic.script import ScriptSource
from simconsole.devices.synthetic.trace_format import TraceHeader
from simconsole.profiles.device import Buttons, CockpitProfile
from simconsole.profiles.parts.script import ScriptPoint, ScriptProfile
from simconsole.values.errors import DeviceError
from simconsole.values.signals import DeviceSample
from simconsole.values.units import RAD_PER_DEG

Say = Callable[[str], None]
Pace = Callable[[int], None]
"""Waits until the tick of this number is due."""

TICK_HZ: Final = 250
SHOW_HZ: Final = 10


def answer(ask: Callable[[str], str], question: str) -> str:
    """Put a question and return what was typed.

    Raises:
        DeviceError: nobody is there to answer.
    """
    try:
        return ask(question)
    except EOFError:
        raise DeviceError("standard input: value at its end: an answer to every question") from None


def realtime(tick_hz: int) -> Pace:
    """Return a pace with absolute deadlines from now on."""
    start_s = time.monotonic()

    def wait(tick: int) -> None:
        left_s = start_s + tick / tick_hz - time.monotonic()
        if left_s > 0.0:
            time.sleep(left_s)

    return wait


def unpaced(tick_hz: int) -> Pace:
    """Return a pace that never waits: nobody is there whose hands it would have to wait for."""
    return lambda tick: None


def list_devices(cockpit: CockpitProfile, *, say: Say, virtual: bool = False) -> dict[str, Any]:
    """List every joystick and the roles it plays in this cockpit.

    Raises:
        DeviceError: SDL does not work.
    """
    with ExitStack() as stack:
        if virtual:
            stack.callback(VirtualCockpit(cockpit).close)
        pygame = sdl_runtime.acquire()
        stack.callback(sdl_runtime.release)
        pygame.event.get()
        devices = []
        for entry, _ in connected_joysticks(pygame):
            ids = (entry.vendor_id, entry.product_id)
            roles = [
                binding.role
                for binding in cockpit.roles
                if any(is_device(entry, device) for device in binding.candidates)
            ]
            boots = [mode.cure for mode in cockpit.boot_modes if (mode.vendor_id, mode.product_id) == ids]
            usb_id = f"{entry.vendor_id:04x}:{entry.product_id:04x}"
            use = ", ".join(roles) or (f"in boot mode: {boots[0]}" if boots else "not used")
            at = f" at {entry.port}" if entry.port else ""
            say(f"{usb_id}  {entry.name}{at}: {entry.axes} axes, {entry.buttons} buttons, {entry.hats} hats: {use}")
            devices.append({**entry._asdict(), "usb_id": usb_id, "roles": roles, "boot_mode": bool(boots)})
    missing = [
        binding.role for binding in cockpit.roles if not any(binding.role in entry["roles"] for entry in devices)
    ]
    if missing:
        say(f"{cockpit.title}: nothing connected for {', '.join(missing)}")
    return {"cockpit": cockpit.title, "devices": devices, "missing_roles": missing}


def check_devices(
    cockpit: CockpitProfile,
    *,
    say: Say,
    duration_s: float,
    virtual: bool = False,
    tick_hz: int = TICK_HZ,
    pace: Pace | None = None,
    show: Callable[[list[str]], None] | None = None,
) -> dict[str, Any]:
    """Watch the cockpit for some seconds and say what moved, what did not and what is wrong.

    `show` takes the live bars, always as many lines, SHOW_HZ times a second.

    Returns:
        Plain values; `ok` is False when this cockpit could not drive.

    Raises:
        DeviceError: a device is missing or cannot drive.
    """
    limits = KernelLimits() if virtual else wheel_limits(cockpit)
    check = CockpitCheck(cockpit, tick_hz)
    lock_rad = 0.5 * cockpit.wheel.lock_to_lock_deg * RAD_PER_DEG
    with _Cockpit(cockpit, virtual, tick_hz) as opened:
        say(f"{cockpit.title}: turn the wheel to both sides, press every pedal, move the lever ({duration_s:g} s)")
        ticks = round(duration_s * tick_hz)
        every = max(1, tick_hz // SHOW_HZ)

        def take(tick: int, sample: DeviceSample) -> None:
            driver = check.add(sample)
            if show is not None and tick % every == 0:
                show(cockpit_lines(driver, lock_rad))

        opened.poll(ticks, pace or realtime(tick_hz), take)
    results = check.results()
    if not virtual:
        results["problems"] += kernel_limits.problems(limits, cockpit)
        results["notes"] += kernel_limits.notes(limits)
        results |= {"ok": not results["problems"], "kernel": limits._asdict()}
    for name, ends in results["pedals"].items():
        say(f"{name}: {ends['least']:.0%} to {ends['most']:.0%}")
    say(f"hand wheel: {results['wheel_deg']['least']:.0f} to {results['wheel_deg']['most']:.0f} deg")
    say(f"gears: {' '.join(map(str, results['gears']))}; buttons: {' '.join(results['buttons']) or 'none'}")
    for line in (*results["problems"], *results["notes"]):
        say(line)
    return {"cockpit": cockpit.title, **results}


def record_devices(
    cockpit: CockpitProfile,
    path: Path,
    *,
    say: Say,
    duration_s: float,
    name: str = "",
    virtual: bool = False,
    tick_hz: int = TICK_HZ,
    pace: Pace | None = None,
) -> dict[str, Any]:
    """Record the cockpit into a trace that `--driver trace:FILE` plays. An interrupt ends it early, whole.

    Args:
        cockpit: The profile.
        path: The trace; replaced if it is there.
        say: Prints a line.
        duration_s: How long.
        name: What the trace calls the cockpit; its title when empty.
        virtual: Plug a virtual cockpit in first, which exercises itself.
        tick_hz: Samples per second.
        pace: When a tick is due; real time when None.

    Raises:
        DeviceError: a device is missing or cannot drive, or the file cannot be written.
    """
    header = TraceHeader(tick_hz, name or cockpit.title)
    with _Cockpit(cockpit, virtual, tick_hz) as opened, TraceWriter(path, header) as writer:
        say(f"{cockpit.title}: recording {duration_s:g} s into {path}")
        ticks = opened.poll(round(duration_s * tick_hz), pace or realtime(tick_hz), writer.write)
    say(f"{path}: {ticks} ticks at {tick_hz} Hz")
    return {"cockpit": cockpit.title, "trace": str(path), "ticks": ticks, "tick_hz": tick_hz}


class _Cockpit:
    """An opened cockpit; a virtual one exercises itself. Use as a context manager."""

    def __init__(self, cockpit: CockpitProfile, virtual: bool, tick_hz: int) -> None:
        self._stack = ExitStack()
        self._plugged: VirtualCockpit | None = None
        with self._stack:
            if virtual:
                self._plugged = VirtualCockpit(cockpit)
                self._stack.callback(self._plugged.close)
                self._hands = ScriptSource(exercise(cockpit), cockpit_settings(cockpit, tick_hz), tick_hz=tick_hz)
            self._source = SdlSource(cockpit)
            self._stack.callback(self._source.close)
            self._stack = self._stack.pop_all()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self._stack.close()

    def poll(self, ticks: int, pace: Pace, take: Callable[[int, DeviceSample], object]) -> int:
        """Hand every sample to `take`; return how many there were. An interrupt ends it early."""
        done = 0
        with suppress(KeyboardInterrupt):
            for tick in range(1, ticks + 1):
                pace(tick)
                if self._plugged is not None:
                    self._plugged.write(self._hands.poll(tick))
                take(tick, self._source.poll(tick))
                done = tick
        return done


def exercise(cockpit: CockpitProfile) -> ScriptProfile:
    """Return a script that works every part of a cockpit once: what a person does to check theirs."""
    points = [ScriptPoint(time_s=0.0, throttle=0.0, brake=0.0, clutch=0.0, handbrake=0.0, hand_wheel_deg=0.0, gear=0)]
    at_s = 0.5
    for pedal in ("throttle", "brake", "clutch", *([] if cockpit.pedals.handbrake is None else ["handbrake"])):
        for share in (0.0, 1.0, 0.0):
            points.append(ScriptPoint(time_s=at_s, **{pedal: share}))  # type: ignore[arg-type]  # a key of its own
            at_s += 0.25
    for angle_deg in (0.0, 90.0, -90.0, 0.0):
        points.append(ScriptPoint(time_s=at_s, hand_wheel_deg=angle_deg))
        at_s += 0.25
    gears = [*range(1, len(cockpit.shifter.gears) + 1), *([] if cockpit.shifter.reverse is None else [-1])]
    for gear in gears:
        points.append(ScriptPoint(time_s=at_s, gear=gear))
        points.append(ScriptPoint(time_s=at_s + 0.2, gear=0))
        at_s += 0.3
    for button in Buttons.__struct_fields__:
        if getattr(cockpit.buttons, button) is not None:
            points.append(ScriptPoint(time_s=at_s, press=[button]))  # type: ignore[list-item]  # the same names
            at_s += 0.25
    return ScriptProfile(title="exercise", points=points)
