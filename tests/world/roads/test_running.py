"""Signals of another simulator on their way through log and shared memory."""

import pytest

from simconsole.values.signals import FAR
from simconsole.world.roads.road_map import Phase
from simconsole.world.roads.running import NONE_RUNNING, Running, RunningNow, changed, changes

PHASES = (Phase(20.0, "Gr"), Phase(3.0, "yr"), Phase(10.0, "rG"))
GREEN, RED = Running("Gr", PHASES, 0, 700.0), Running("rG", PHASES, 2, FAR)


def test_whoever_follows_all_changes_knows_all_signals() -> None:
    steps: list[RunningNow] = [
        {"a": GREEN},
        {"a": GREEN, "b": RED},
        {"a": RED, "b": RED},
        {"a": RED, "b": RED._replace(phases=PHASES[:1])},
        {"b": RED},
        {},
    ]
    before: RunningNow = NONE_RUNNING
    followed: RunningNow = NONE_RUNNING
    for now in steps:
        content = changes(before, now)
        assert content is not None
        followed = changed(followed, content)
        assert followed == now
        before = now
    assert changes(before, {}) is None


def test_a_program_is_told_once() -> None:
    first, second = changes(NONE_RUNNING, {"a": GREEN}), changes({"a": GREEN}, {"a": RED})
    assert first is not None
    assert b"phases" in first
    assert second == b'{"a":{"phase":2,"states":"rG","switch_tick":1000000000.0}}'


def test_logs_of_before_tell_what_is_shown_and_nothing_of_later() -> None:
    now = changed(NONE_RUNNING, b'{"a":{"states":"Gr","switch_tick":700.0}}')
    assert now == {"a": Running("Gr", (), 0, FAR)}


@pytest.mark.parametrize("content", [b"[]", b"{", b'{"a":{}}', b'{"a":{"states":"G","switch_tick":1,"phases":[[1]]}}'])
def test_what_is_none_is_refused(content: bytes) -> None:
    with pytest.raises(ValueError, match="signals: "):
        changed(NONE_RUNNING, content)
