"""A driver's trace from a bag: joystick messages become the samples that `--driver trace:FILE` plays."""

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Final, NamedTuple

from simconsole.bridge.console.topics import SHIFTER_BUTTONS, WHEEL_BUTTONS
from simconsole.devices.sources.trace_files import TraceWriter
from simconsole.devices.synthetic.trace_format import TraceHeader, aged
from simconsole.profiles.device import CockpitProfile
from simconsole.recording.imports.bag import Bag
from simconsole.values.errors import ProfileError, RecordingError
from simconsole.values.host.files import replaced
from simconsole.values.kernels import is_finite
from simconsole.values.signals import NO_SAMPLE, DeviceSample
from simconsole.values.units import NS_PER_S

JOY: Final = "sensor_msgs/msg/Joy"
LONGEST_S: Final = 86_400
"""The longest drive that a session may have; a bag with later messages has a damaged time."""
AXES: Final = "wheel=0,throttle=1,brake=2,clutch=3,handbrake=4,hat_x=5,hat_y=6"
BUTTONS: Final = f"wheel=0:{WHEEL_BUTTONS},shifter={WHEEL_BUTTONS}:{SHIFTER_BUTTONS}"
"""The console's own topic /console/joy."""
_FIELDS: Final = {
    **{name: f"{name}_axis" for name in ("wheel", "throttle", "brake", "clutch", "handbrake")},
    "hat_x": "hat_x",
    "hat_y": "hat_y",
}
_MAX_BUTTONS: Final = 24
_AXIS: Final = re.compile(r"(\w+)=(-?)(\d{1,3})")
_BUTTON: Final = re.compile(r"(wheel|shifter)=(\d{1,3}):(\d{1,3})")
_TOLERANCE: Final = 1e-3
"""How far beyond 1 an axis may be by rounding."""


class JoyMapping(NamedTuple):
    """Where a joystick message has what a cockpit's sample needs.

    `axes`: place and sign by field; `buttons`: first place and number by field; `rest`: what is not in the message.
    """

    axes: dict[str, tuple[int, float]]
    buttons: dict[str, tuple[int, int]]
    rest: DeviceSample


def joy_mapping(axes: str | None, buttons: str | None, cockpit: CockpitProfile) -> JoyMapping:
    """Return the mapping that two texts such as AXES and BUTTONS say; None for the console's own.

    What is not mapped rests: the wheel in the middle, a pedal where the cockpit's profile says that it is released.

    Raises:
        ProfileError: a text that is no mapping; says what one looks like.
    """
    places: dict[str, tuple[int, float]] = {}
    for part in (AXES if axes is None else axes).split(","):
        found = _AXIS.fullmatch(part)
        if found is None or found[1] not in _FIELDS:
            raise ProfileError(f"--axes: value {part!r}: NAME=PLACE or NAME=-PLACE, of {', '.join(_FIELDS)}")
        places[_FIELDS[found[1]]] = (int(found[3]), -1.0 if found[2] else 1.0)
    masks: dict[str, tuple[int, int]] = {}
    for part in filter(None, (BUTTONS if buttons is None else buttons).split(",")):
        found = _BUTTON.fullmatch(part)
        if found is None or int(found[3]) > _MAX_BUTTONS:
            raise ProfileError(f"--buttons: value {part!r}: wheel=FIRST:NUMBER or shifter=, up to {_MAX_BUTTONS}")
        masks[f"{found[1]}_buttons"] = (int(found[2]), int(found[3]))
    pedals = cockpit.pedals
    bound = {name: getattr(pedals, name) for name in ("throttle", "brake", "clutch", "handbrake")}
    released = {f"{name}_axis": pedal.rest_raw for name, pedal in bound.items() if pedal is not None}
    present = dict.fromkeys((name for name in DeviceSample._fields if name.endswith("_age_ticks")), 0.0)
    return JoyMapping(places, masks, NO_SAMPLE._replace(**released, **present))


def write_trace(
    bag_path: Path,
    path: Path,
    mapping: JoyMapping,
    *,
    tick_hz: int,
    cockpit: str,
    topic: str | None = None,
    on_tick: Callable[[int], None] = lambda tick: None,
) -> int:
    """Write the trace of a bag to `path`, replacing what was there; return the number of its ticks.

    Args:
        bag_path: the bag.
        path: the trace.
        mapping: what its joystick messages mean.
        tick_hz: ticks of the session that will play it.
        cockpit: what the trace calls the cockpit.
        topic: which joystick; None for the only one.
        on_tick: told each tick.

    Raises:
        RecordingError: no bag, damaged, no such topic, or a message that does not fit the mapping.
        DeviceError: the trace cannot be written.
    """
    bag = Bag(bag_path, (JOY,))
    name = _joystick(bag, topic)
    ticks = 0
    with replaced(path) as draft, TraceWriter(draft, TraceHeader(tick_hz, cockpit)) as writer:
        for ticks, sample in trace_rows(bag, name, mapping, tick_hz):
            writer.write(ticks, sample)
            on_tick(ticks)
    return ticks


def trace_rows(bag: Bag, topic: str, mapping: JoyMapping, tick_hz: int) -> Iterator[tuple[int, DeviceSample]]:
    """Yield the samples from tick 1 to the last message: each tick the newest one, its age in ticks.

    A message belongs to the first tick that is not earlier. Before the first one the devices are not there.
    """
    tick, held, held_at = 1, NO_SAMPLE, 1
    for number, message in enumerate(bag.messages((topic,)), start=1):
        coming = max(1, -(-message.time_ns * tick_hz // NS_PER_S))
        if not -LONGEST_S * NS_PER_S <= message.time_ns <= LONGEST_S * NS_PER_S:
            raise RecordingError(f"{bag.path}: {topic}: message {number}: {message.time_ns} ns: within {LONGEST_S} s")
        while tick < coming:
            yield tick, _held(held, tick - held_at)
            tick += 1
        held, held_at = _sample(message.plain, mapping, f"{bag.path}: {topic}: message {number}"), tick
    yield tick, _held(held, tick - held_at)


def _held(sample: DeviceSample, ticks: int) -> DeviceSample:
    return sample if sample is NO_SAMPLE else aged(sample, float(ticks))


def _joystick(bag: Bag, topic: str | None) -> str:
    names = sorted({found.name for found in bag.topics if found.type == JOY and found.messages})
    if topic is not None and topic in names:
        return topic
    if topic is None and len(names) == 1:
        return names[0]
    said = topic or ", ".join(names) or "none"
    wanted = f"--topic with one of {', '.join(names)}" if names else f"a topic of type {JOY} with messages"
    raise RecordingError(f"{bag.path}: joystick: value {said}: {wanted}")


def _sample(plain: dict[str, Any], mapping: JoyMapping, place: str) -> DeviceSample:
    values: dict[str, float] = {}
    axes, buttons = plain["axes"], plain["buttons"]
    for field, (index, sign) in mapping.axes.items():
        if index >= len(axes):
            raise RecordingError(f"{place}: axes: {len(axes)} of them, and {field} shall be number {index}")
        value = sign * float(axes[index])
        if not is_finite(value) or abs(value) > 1.0 + _TOLERANCE:
            raise RecordingError(f"{place}: axes[{index}]: value {value:g}: -1 to 1")
        value = max(-1.0, min(1.0, value))
        values[field] = float(round(value)) if field.startswith("hat") else value
    for field, (first, number) in mapping.buttons.items():
        if first + number > len(buttons):
            raise RecordingError(
                f"{place}: buttons: {len(buttons)} of them, {field} shall be {first} to {first + number - 1}"
            )
        pressed = (bool(button) << bit for bit, button in enumerate(buttons[first : first + number]))
        values[field] = float(sum(pressed))
    return mapping.rest._replace(**values)
