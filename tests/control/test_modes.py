"""The table, alone: every pair, every order, and what it must never allow."""

import itertools

import pytest

from simconsole.control.modes import MEANING, MODES, REACTIONS, REASONS, TRIGGERS, Trigger, deciding_trigger, next_mode
from simconsole.control.modes import reason_of as reason
from simconsole.signals import Mode

PAIRS = list(itertools.product(Mode, Trigger))
ACTS = {Trigger.MANUAL_ASKED, Trigger.RESET, Trigger.AUTONOMOUS_ASKED, Trigger.SHARED_ASKED, Trigger.EMERGENCY}


def after(mode: Mode, *present: Trigger) -> Mode:
    mask = sum(1 << trigger for trigger in present)
    return Mode(int(next_mode(float(mode), deciding_trigger(float(mode), mask))))


@pytest.mark.parametrize(("mode", "trigger"), PAIRS)
def test_every_pair_does_what_the_table_says(mode: Mode, trigger: Trigger) -> None:
    assert after(mode, trigger) is REACTIONS[mode].get(trigger, mode)
    expected = trigger if trigger in REACTIONS[mode] else -1
    assert deciding_trigger(float(mode), 1 << trigger) == expected


def test_the_table_is_complete_and_names_only_changes() -> None:
    assert set(REACTIONS) == set(Mode)
    assert len(PAIRS) == MODES * TRIGGERS == 128
    assert set(MEANING) == set(REASONS) == set(Trigger)
    assert all(target is not mode for mode in Mode for target in REACTIONS[mode].values())


@pytest.mark.parametrize("mode", Mode)
def test_of_two_triggers_the_stronger_one_that_matters_decides(mode: Mode) -> None:
    for strong, weak in itertools.combinations(Trigger, 2):
        first = strong if strong in REACTIONS[mode] else weak
        assert after(mode, strong, weak) is REACTIONS[mode].get(first, mode)


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
