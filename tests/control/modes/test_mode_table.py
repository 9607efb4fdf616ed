"""The table, alone: every pair, every order, and what it must never allow."""

import itertools

import pytest

from simconsole.control.modes.mode_table import (
    MEANING,
    MODES,
    REACTIONS,
    REASONS,
    TRIGGERS,
    Trigger,
    outcome,
    reacts,
    takes,
)
from simconsole.control.modes.mode_table import reason_of as reason
from simconsole.values.signals import Mode

PAIRS = list(itertools.product(Mode, Trigger))
ACTS = {Trigger.MANUAL_ASKED, Trigger.RESET, Trigger.AUTONOMOUS_ASKED, Trigger.SHARED_ASKED, Trigger.EMERGENCY}


def after(mode: Mode, *present: Trigger) -> Mode:
    mask = sum(1 << trigger for trigger in present)
    return Mode(int(outcome(float(mode), mask).mode))


@pytest.mark.parametrize(("mode", "trigger"), PAIRS)
def test_every_pair_does_what_the_table_says(mode: Mode, trigger: Trigger) -> None:
    assert after(mode, trigger) is REACTIONS[mode].get(trigger, mode)
    expected = trigger if trigger in REACTIONS[mode] else -1
    assert outcome(float(mode), 1 << trigger).trigger == expected
    assert reacts(float(mode), trigger) == (trigger in REACTIONS[mode])


def test_the_table_is_complete_and_names_only_changes() -> None:
    assert set(REACTIONS) == set(Mode)
    assert len(PAIRS) == MODES * TRIGGERS == 128
    assert set(MEANING) == set(REASONS) == set(Trigger)
    assert all(target is not mode for mode in Mode for target in REACTIONS[mode].values())


@pytest.mark.parametrize("mode", Mode)
def test_whatever_takes_authority_takes_effect_and_what_asks_for_more_gives_way(mode: Mode) -> None:
    for present in itertools.chain(itertools.combinations(Trigger, 2), itertools.combinations(Trigger, 3)):
        assert after(mode, *present) is by_the_rule(mode, present), present


def by_the_rule(mode: Mode, present: tuple[Trigger, ...]) -> Mode:
    """The rule of docs/modes.md, in its own words."""

    def taking(where: Mode) -> list[Trigger]:
        still = where in (Mode.PARKED, Mode.STOPPED)
        return [
            trigger
            for trigger in sorted(present)
            if trigger <= Trigger.NO_REACTION and not (still and trigger is Trigger.MANUAL_ASKED)
        ]

    now, effective = mode, False
    for trigger in Trigger:
        if trigger in taking(now) and trigger in REACTIONS[now]:
            now, effective = REACTIONS[now][trigger], True
    if effective:
        return now
    for trigger in sorted(present):
        target = REACTIONS[mode].get(trigger)
        if target is not None and not any(other in REACTIONS[target] for other in taking(target)):
            return target
    return mode


def test_no_trigger_that_takes_authority_hides_another() -> None:
    """The pairs that were swallowed once: each of them reacts in the mode that the other leads to."""
    assert after(Mode.AUTONOMOUS, Trigger.DEVICE_LOST, Trigger.COMMANDER_LOST) is Mode.MINIMAL_RISK
    assert after(Mode.AUTONOMOUS, Trigger.DEVICE_LOST, Trigger.COMMAND_STALE) is Mode.MINIMAL_RISK
    assert after(Mode.AUTONOMOUS, Trigger.MANUAL_ASKED, Trigger.LOOP_STALL) is Mode.MINIMAL_RISK
    assert after(Mode.MANUAL, Trigger.COMMANDER_LOST, Trigger.AUTONOMOUS_ASKED) is Mode.MANUAL
    assert after(Mode.TAKEOVER_REQUESTED, Trigger.TAKEOVER_ASKED, Trigger.AUTONOMOUS_ASKED) is Mode.TAKEOVER_REQUESTED
    assert after(Mode.STOPPED, Trigger.MANUAL_ASKED, Trigger.LOOP_STALL) is Mode.STOPPED
    assert after(Mode.STOPPED, Trigger.RESET, Trigger.COMMAND_STALE, Trigger.TAKEOVER_ASKED) is Mode.PARKED


def test_coming_to_rest_takes_nothing() -> None:
    assert reacts(float(Mode.MINIMAL_RISK), int(Trigger.STANDSTILL))
    assert not takes(float(Mode.MINIMAL_RISK), int(Trigger.STANDSTILL))


def test_manual_in_a_car_that_stands_takes_nothing() -> None:
    asked = int(Trigger.MANUAL_ASKED)
    assert [mode for mode in Mode if reacts(float(mode), asked) and not takes(float(mode), asked)] == [
        Mode.PARKED,
        Mode.STOPPED,
    ]


@pytest.mark.parametrize("mode", Mode)
def test_nothing_present_changes_nothing(mode: Mode) -> None:
    assert after(mode) is mode


@pytest.mark.parametrize("mode", Mode)
def test_emergency_wins_over_everything_from_everywhere(mode: Mode) -> None:
    others = [trigger for trigger in Trigger if trigger is not Trigger.RESET]
    assert after(mode, *others) is Mode.EMERGENCY_STOP
    assert after(mode, Trigger.EMERGENCY) is Mode.EMERGENCY_STOP


def test_autonomy_is_only_ever_entered_by_asking_for_it() -> None:
    for mode, trigger in PAIRS:
        if after(mode, trigger) is not mode:
            assert (after(mode, trigger) is Mode.AUTONOMOUS) == (trigger is Trigger.AUTONOMOUS_ASKED)
            assert (after(mode, trigger) is Mode.SHARED) == (trigger is Trigger.SHARED_ASKED)
    entered = {mode for mode in Mode for target in REACTIONS[mode].values() if target is Mode.TAKEOVER_REQUESTED}
    assert entered == {Mode.AUTONOMOUS}


@pytest.mark.parametrize("mode", [Mode.STOPPED, Mode.EMERGENCY_STOP])
def test_latched_modes_are_left_by_an_act_only(mode: Mode) -> None:
    assert set(REACTIONS[mode]) <= ACTS


def test_every_mode_can_be_reached_and_left_for_manual() -> None:
    reach = {mode: {mode} for mode in Mode}
    for _ in Mode:
        for mode in Mode:
            for target in REACTIONS[mode].values():
                reach[mode] |= reach[target]
    assert all(reach[mode] == set(Mode) for mode in Mode)


def test_each_trigger_gives_its_reason() -> None:
    for trigger in Trigger:
        assert reason(trigger) == float(REASONS[trigger])
