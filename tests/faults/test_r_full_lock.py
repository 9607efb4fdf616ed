"""R06 with every rate and pattern: full lock as a step, a ramp, on and off, beside silence, by fast and slow senders.

The judge reads docs/faults.md, not the console: a command is wild if speed^2 tan(angle) / wheelbase is more than
10 m/s2 when it comes. Time counts from the last one that was not.
"""

import math
import random
from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np
import pytest

from simconsole.assembly import ResolvedSession, assemble
from simconsole.compiling import compiled
from simconsole.devices.settings import settings
from simconsole.devices.uncalibrate import Intent, uncalibrate
from simconsole.drive import Cast, run
from simconsole.memory import MemoryRecorder
from simconsole.pacing import UnpacedPacer
from simconsole.pipeline import Console, ConsoleState
from simconsole.profile_files import parse
from simconsole.profiles.session import SessionProfile
from simconsole.rows import Snapshot
from simconsole.session_files import override, resolve
from simconsole.signals import (
    NO_COMMAND,
    NO_EVENTS,
    DeviceSample,
    Event,
    EventInput,
    Mode,
    Reason,
    RemoteCommand,
    RemoteKind,
)
from tests.samples import Measured, Sample

SESSION = "schema: 1\nscenario: {vehicle: hatchback}\ndevices: {driver: none}\n"
RATES_HZ = (50, 250, 1000)
STALE_S = 0.2
WILD_MPS2 = 10.0
MOST_RADPS = 1.0
LOCK_RAD = math.radians(34.0)
SPEED_MPS = 13.0
PATTERN_S = 3.0
Pattern = Callable[[float, random.Random], float | None]
"""The angle of a command sent so many seconds after the fault began; None: it is not sent."""

PATTERNS: dict[str, Pattern] = {
    "step": lambda t_s, chance: LOCK_RAD,
    "ramp": lambda t_s, chance: min(LOCK_RAD, LOCK_RAD * t_s),
    "on and off": lambda t_s, chance: -LOCK_RAD if int(t_s / 0.3) % 2 else 0.01,
    "left and right": lambda t_s, chance: math.copysign(LOCK_RAD, math.sin(12.0 * t_s)),
    "after silence": lambda t_s, chance: None if t_s < 0.19 else LOCK_RAD,
    "now and then": lambda t_s, chance: chance.choice((None, None, LOCK_RAD, -LOCK_RAD, 0.0)),
    "mostly missing": lambda t_s, chance: chance.choice((LOCK_RAD, 0.005, *(None,) * 12)),
}


ALWAYS = ("step", "left and right", "after silence")


class Seated:
    """A person with hands and feet at rest."""

    def __init__(self, resolved: ResolvedSession, tick_hz: int) -> None:
        self._rest = uncalibrate(Intent(), settings(resolved.cockpit, tick_hz))

    def poll(self, tick: int) -> DeviceSample:
        return self._rest

    def close(self) -> None:
        pass


class Sender:
    """A controller that drives straight on, engaged at 2 s, until its fault; then a pattern at a rate of its own."""

    def __init__(self, tick_hz: int, first_tick: int, pattern: Pattern | None, period_s: float, seed: int) -> None:
        self._tick_hz, self._first, self._pattern = tick_hz, first_tick, pattern
        self._period = max(1, round(period_s * tick_hz))
        self._chance = random.Random(seed)
        self._command, self._received = NO_COMMAND, -1
        self.sent: list[tuple[int, float]] = []
        if first_tick > 1:
            self._say(first_tick - 1, 0.0)

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        after = tick - self._first
        angle: float | None = 0.0
        if self._pattern is not None:
            angle = self._pattern(after / self._tick_hz, self._chance) if after % self._period == 0 else None
        if angle is not None:
            self._say(tick, angle)
        events = EventInput(float(Event.REQUEST_AUTONOMOUS)) if tick == 2 * self._tick_hz else NO_EVENTS
        if self._received < 0:
            return NO_COMMAND, events
        return self._command._replace(age_ticks=float(tick - self._received)), events

    def _say(self, tick: int, angle: float) -> None:
        self._received = tick
        self.sent.append((tick, angle))
        speed_mps = min(SPEED_MPS, 1.0 + max(0.0, 1.5 * (tick / self._tick_hz - 2.0)))
        self._command = NO_COMMAND._replace(
            kind=float(RemoteKind.SPEED), sequence=float(tick), road_wheel_rad=angle, speed_mps=speed_mps
        )


class Ready(NamedTuple):
    """A console that drives at speed."""

    resolved: ResolvedSession
    console: Console
    state: ConsoleState


@cache
def ready(tick_hz: int) -> Ready:
    resolved = resolve(override(parse(SESSION, SessionProfile, "session"), mode={"tick_hz": tick_hz}))
    console, state = assemble(resolved, compiled)
    sender = Sender(tick_hz, 1, None, 0.0, 0)
    cast = Cast(Seated(resolved, tick_hz), sender, MemoryRecorder(30 * tick_hz, console.width), (), UnpacedPacer())
    state = run(console, state, cast, 14 * tick_hz)
    snapshot = Snapshot(state.tick, tick_hz, state.row)
    assert snapshot.arbitration.mode == Mode.AUTONOMOUS, Reason(int(snapshot.arbitration.reason))
    assert snapshot.vehicle.vx_mps > 0.9 * SPEED_MPS
    return Ready(resolved, console, ConsoleState(state.tick, state.row.copy()))


class Answer(NamedTuple):
    """What a pattern led to."""

    longest_s: float
    """The longest that the car was AUTONOMOUS after the last plausible command."""
    left: bool


def answer(tick_hz: int, pattern: Pattern, period_s: float, seed: int) -> Answer:
    """Drive a pattern; judge each tick of it."""
    resolved, console, start = ready(tick_hz)
    ticks = round(PATTERN_S * tick_hz)
    sender = Sender(tick_hz, start.tick + 1, pattern, period_s, seed)
    recorder = MemoryRecorder(ticks, console.width)
    cast = Cast(Seated(resolved, tick_hz), sender, recorder, (), UnpacedPacer())
    run(console, ConsoleState(start.tick, start.row.copy()), cast, ticks)
    rows = np.vstack((start.row, recorder.rows))  # the row before each tick, too

    def column(name: str) -> np.ndarray:
        return rows[:, console.columns.index(name)]

    mode, angle, speed = column("arbitration.mode"), column("command.road_wheel_rad"), column("vehicle.vx_mps")
    lateral = {
        tick: speed[tick - start.tick - 1] ** 2 * math.tan(abs(sent)) / console.platform.wheelbase_m
        for tick, sent in sender.sent
        if tick > start.tick
    }
    wild = {tick for tick, mps2 in lateral.items() if mps2 > WILD_MPS2}
    autonomous = np.flatnonzero(mode == Mode.AUTONOMOUS) + start.tick
    plausible = np.array(sorted({start.tick} | set(lateral) - wild))
    latest = plausible[np.searchsorted(plausible, autonomous, side="right") - 1]
    longest = int((autonomous - latest).max()) + 1  # the tick that is not autonomous any more
    assert np.abs(np.diff(angle)).max() <= MOST_RADPS / tick_hz + 1e-9, "the rate of the wheels"
    driven = mode[1:] == Mode.AUTONOMOUS
    asked = speed[:-1] ** 2 * np.tan(np.abs(angle[1:])) / console.platform.wheelbase_m
    assert (asked[driven] <= WILD_MPS2).all(), "a wild angle is never commanded"
    left = np.flatnonzero(~driven)
    if len(left):
        reason = column("arbitration.reason")[1:][left[0]]
        assert reason in (Reason.COMMAND_INVALID, Reason.COMMAND_STALE)
    return Answer(longest / tick_hz, bool(len(left)))


@pytest.mark.fault("R06")
@pytest.mark.parametrize("tick_hz", RATES_HZ)
def test_r06_autonomy_ends_in_time_after_the_last_plausible_command(
    tick_hz: int, sample: Sample, measured: Measured
) -> None:
    """Every pattern by senders of 100 Hz down to 4 Hz, and by some of any rate."""
    chance = random.Random(sample.seed)
    periods_s = [0.01, 0.02, 0.05, 0.1, 0.16, 0.19, 0.25]
    periods_s += [chance.uniform(0.004, 0.4) for _ in range(sample.of(5, 500))]
    bar_s = STALE_S + 0.010 + 1.0 / tick_hz
    longest_s = 0.0
    for name, pattern in PATTERNS.items():
        for period_s in periods_s:
            seed = chance.randrange(1 << 30)
            found = answer(tick_hz, pattern, period_s, seed)
            longest_s = max(longest_s, found.longest_s)
            assert found.longest_s <= bar_s, (name, period_s, seed)
            assert found.left or name not in ALWAYS, (name, period_s, seed)
    seen = f"{1e3 * longest_s:.0f} ms, {len(PATTERNS) * len(periods_s)} drives"
    measured("R06", f"AUTONOMOUS after the last plausible command, {tick_hz} Hz", seen, f"{1e3 * bar_s:.0f} ms")
