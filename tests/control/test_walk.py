"""Millions of ticks of arbitration in which everything happens at once, each foreseen by an oracle of its own."""

import itertools
from collections.abc import Callable
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.control.requests.control_settings import settings
from simconsole.profiles.control import ControlProfile
from simconsole.values.host.jit import compiled
from simconsole.values.layout import read
from simconsole.values.signals import Commander, Mode, Reason
from tests.control.nasty import DRAWS, STATE, fresh_start
from tests.control.oracle import blank
from tests.control.oracle_rules import COUNT, TRIGGERS, WIDTH, may_meet, rules
from tests.control.random_drives import ARBITRATION, ECU_LINK, OUTPUT_WIDTH, ROS_LINK
from tests.control.walk import BREACHES, COLUMNS, MODES, RECENT, walk
from tests.samples import Sample

STEERING_RATIO, LOCK_RAD, WHEELBASE_M = 15.0, 0.6, 2.6
RATES_HZ: Final = (50, 100, 125, 200, 250, 500, 1000)
CHUNK: Final = 50_000
MOST_UNMET: Final = 100
"""Pairs of triggers that the short walk may leave out in some mode; the long one leaves out none."""


class Variant(NamedTuple):
    """What a session can be, as far as arbitration is concerned."""

    tick_hz: int
    person_required: bool
    manual_automatic: bool
    preferred: Commander
    shared_authority: str
    shared_steering: str
    wheel_motor: float


VARIANTS: Final = tuple(
    Variant(*each)
    for each in itertools.product(
        RATES_HZ,
        (True, False),
        (False, True),
        (Commander.ROS, Commander.ECU),
        ("fixed", "line_crossing", "traded"),
        ("blended", "haptic"),
        (0.0, 1.0),
    )
)
TIMES: Final[tuple[dict[str, float], ...]] = (
    {},
    {"minimal_risk_after_s": 1.5, "escalation_s": 0.5},
    {"minimal_risk_after_s": 0.4, "escalation_s": 0.2, "reengage_stable_s": 0.3, "standstill_s": 0.1},
    {"command_stale_s": 0.05, "minimal_risk_after_s": 0.8, "commander_lease_s": 0.1, "invalid_commands_max": 3},
    {"command_stale_s": 0.5, "minimal_risk_after_s": 2.0, "commander_lease_s": 2.0, "invalid_commands_max": 100},
    {"command_stale_s": 0.137, "steering_override_hold_s": 0.11, "engage_stable_s": 0.0, "shared_longitudinal": 0.5},
)
"""Times other than the profile's own, most of them short: so every wait runs out in a walk."""


class Walked(NamedTuple):
    """What a walk of one variant saw."""

    breach: str
    beyond_ticks: float


def walked(variant: Variant, times: dict[str, float], ticks: int, seed: int, counts: NDArray[np.float64]) -> Walked:
    """Walk one variant, and add to `counts` which pairs of triggers met in which mode."""
    profile = ControlProfile(
        person_required=variant.person_required,
        manual_automatic=variant.manual_automatic,
        shared_authority=variant.shared_authority,  # type: ignore[arg-type]  # one of its words
        shared_steering=variant.shared_steering,  # type: ignore[arg-type]
        **times,  # type: ignore[arg-type]
    )
    hz = variant.tick_hz
    s = np.array(settings(profile, STEERING_RATIO, LOCK_RAD, WHEELBASE_M, hz, variant.preferred))
    r = np.array(rules(profile, hz, variant.preferred, WHEELBASE_M))
    state, foreseen, before = np.zeros(STATE), np.zeros(WIDTH), np.zeros(OUTPUT_WIDTH)
    recent = np.zeros((RECENT, len(COLUMNS)))
    fresh_start(state)
    blank(foreseen)
    figures = np.array([0.0, 0.0, variant.wheel_motor, 0.0, 0.0, profile.minimal_risk_after_s])
    rng = np.random.default_rng(seed)
    go = compiled(walk)
    while figures[0] < ticks:
        draws = rng.random((min(CHUNK, ticks - int(figures[0])), DRAWS))
        of_a_tick = np.zeros(COUNT), np.zeros(len(COLUMNS))
        breach = go(draws, state, foreseen, before, recent, counts, figures, s, r, *of_a_tick, 1.0 / hz)
        if breach:
            told = f"{BREACHES[int(breach)]} at tick {figures[0] - 1:.0f} of {variant}, {times}, seed {seed}: "
            told += f"expected {Mode(int(figures[3])).name}, seen {Mode(int(figures[4])).name}\n"
            return Walked(
                told + story(recent, int(figures[0]), foreseen, before), figures[1] - profile.command_stale_s * hz
            )
    return Walked("", figures[1] + 1.0 - profile.command_stale_s * hz)


def story(recent: NDArray[np.float64], ticks: int, foreseen: NDArray[np.float64], before: NDArray[np.float64]) -> str:
    """Return the inputs of the last ticks, those that are not 0, and what came of the last."""
    lines = []
    for tick in range(max(0, ticks - RECENT), ticks):
        row = recent[tick % RECENT]
        lines.append(", ".join(f"{name}={value:.9g}" for name, value in zip(COLUMNS, row, strict=True) if value))
    lines.append(f"oracle {[round(float(v), 4) for v in foreseen]}")
    arbitration = read(before, ARBITRATION)
    lines.append(f"{arbitration} {Reason(int(arbitration.reason)).name}")
    ros, ecu = before[ROS_LINK.slice].tolist(), before[ECU_LINK.slice].tolist()
    lines.append(f"ROS {ros} ECU {ecu}")
    return "\n".join(lines)


def missed(counts: NDArray[np.float64], least: int) -> list[str]:
    """Return the pairs of triggers that can meet in a mode and have met there less often than `least`."""
    met = counts.reshape(MODES, COUNT, COUNT)
    return [
        f"{mode.name}: {TRIGGERS[one]} {TRIGGERS[other]} {met[mode, one, other]:.0f}"
        for mode in Mode
        for one, other in itertools.combinations_with_replacement(range(COUNT), 2)
        if may_meet(mode, one, other) and met[mode, one, other] < least
    ]


def table(counts: NDArray[np.float64]) -> str:
    """Return how many ticks each trigger was present in, by mode."""
    met = counts.reshape(MODES, COUNT, COUNT)
    lines = [" " * 18 + "".join(f"{mode.name[:12]:>14}" for mode in Mode)]
    for one, name in enumerate(TRIGGERS):
        lines.append(f"{name:<18}" + "".join(f"{met[mode, one, one]:>14.0f}" for mode in Mode))
    return "\n".join(lines)


def test_a_walk_ends_every_tick_in_the_mode_that_is_foreseen(
    sample: Sample, record_property: Callable[[str, object], None]
) -> None:
    total = sample.of(2_000_000, 200_000_000)
    counts = np.zeros(MODES * COUNT * COUNT)
    longest_ticks = dict.fromkeys(RATES_HZ, -np.inf)
    share = np.array([variant.tick_hz**0.5 for variant in VARIANTS])  # slow waits take more ticks at a higher rate
    ticks = np.ceil(total * share / share.sum()).astype(int)
    breaches = []
    for index, variant in enumerate(VARIANTS):
        times = TIMES[(index + sample.seed) % len(TIMES)]
        seen = walked(variant, times, int(ticks[index]), sample.seed + index, counts)
        breaches += [seen.breach] * bool(seen.breach)
        longest_ticks[variant.tick_hz] = max(longest_ticks[variant.tick_hz], seen.beyond_ticks)
    beyond = ", ".join(f"{hz} Hz {most:.1f} ticks, {1000.0 * most / hz:.1f} ms" for hz, most in longest_ticks.items())
    record_property(
        "walk", f"{ticks.sum()} ticks, {len(breaches)} breaches; left after command_stale_s and at most {beyond}"
    )
    print(table(counts))
    assert not breaches, "\n\n".join(breaches[:3])
    unmet = missed(counts, sample.of(1, 3))
    print(f"{len(unmet)} pairs not met", *unmet, sep="\n")
    assert len(unmet) <= sample.of(MOST_UNMET, 0), unmet
