import math

import pytest

from simconsole.control.link import watch_link
from simconsole.control.settings import ControlSettings
from simconsole.signals import NEVER_TICKS, Link, LinkState, RemoteCommand, RemoteKind

NO_LINK = Link(*(0.0,) * len(Link._fields))
REMOTE = RemoteCommand(*(0.0,) * len(RemoteCommand._fields))._replace(kind=float(RemoteKind.SPEED), sequence=1.0)


@pytest.mark.parametrize(
    ("fields", "fresh"),
    [
        ({}, 1.0),
        ({"age_ticks": 49.0}, 1.0),
        ({"age_ticks": 50.0}, 0.0),
        ({"age_ticks": NEVER_TICKS}, 0.0),
        ({"age_ticks": -1.0}, 0.0),
        ({"sequence": 0.0}, 0.0),
        ({"kind": 0.0}, 0.0),
        ({"kind": 17.0}, 0.0),
    ],
)
def test_fresh(fields: dict[str, float], fresh: float, control: ControlSettings) -> None:
    link = watch_link(REMOTE._replace(**fields), NO_LINK, control)
    assert (link.fresh, link.fresh_ticks, link.invalid) == (fresh, fresh, 0.0)


def test_refused_commands_count_in_a_row(control: ControlSettings) -> None:
    link = watch_link(REMOTE, NO_LINK, control)
    for refused in range(1, 6):
        link = watch_link(REMOTE._replace(refused=float(refused)), link, control)
        assert (link.invalid_run, link.fresh_ticks) == (float(refused), 0.0)
        assert link.invalid == (1.0 if refused == 5 else 0.0)
    link = watch_link(REMOTE._replace(refused=5.0, sequence=2.0), link, control)
    assert (link.invalid_run, link.invalid, link.fresh_ticks) == (0.0, 0.0, 1.0)


def test_many_refused_in_one_tick_count_at_once(control: ControlSettings) -> None:
    link = watch_link(REMOTE, NO_LINK, control)
    assert watch_link(REMOTE._replace(refused=5.0), link, control).invalid == 1.0
    huge = watch_link(REMOTE._replace(refused=1e308), link, control)
    assert (huge.invalid_run, huge.invalid) == (1e9, 1.0)


def test_a_counter_that_starts_anew_is_no_refusal(control: ControlSettings) -> None:
    link = watch_link(REMOTE._replace(refused=0.0), NO_LINK._replace(refused_seen=7.0, sequence_seen=1.0), control)
    assert (link.refused_seen, link.invalid_run, link.fresh) == (0.0, 0.0, 1.0)


def test_a_command_that_is_no_number_is_invalid_and_remembered_as_nothing(control: ControlSettings) -> None:
    before = NO_LINK._replace(sequence_seen=3.0, refused_seen=2.0, invalid_run=1.0, fresh_ticks=99.0)
    for field in ("sequence", "refused", "speed_mps"):
        link = watch_link(REMOTE._replace(**{field: math.nan}), before, control)
        assert link == (3.0, 2.0, 1.0, 0.0, 0.0, 1.0, 0.0, LinkState.INVALID)


def test_state_in_one_word(control: ControlSettings) -> None:
    assert watch_link(REMOTE._replace(sequence=0.0), NO_LINK, control).state == LinkState.NEVER
    link = watch_link(REMOTE, NO_LINK, control)
    assert link.state == LinkState.UNSTEADY
    for _ in range(int(control.engage_stable_ticks)):
        link = watch_link(REMOTE, link, control)
    assert link.state == LinkState.STEADY
    almost = NO_LINK._replace(sequence_seen=1.0, fresh_ticks=control.engage_stable_ticks - 2.0)
    assert watch_link(REMOTE, almost, control).state == LinkState.UNSTEADY
    steady = almost._replace(fresh_ticks=control.engage_stable_ticks - 1.0)
    assert watch_link(REMOTE, steady, control).state == LinkState.STEADY
    assert watch_link(REMOTE._replace(age_ticks=50.0), link, control).state == LinkState.STALE
    assert watch_link(REMOTE._replace(refused=5.0), link, control).state == LinkState.INVALID


def test_a_fresh_command_renews_the_lease_and_nothing_else_does(control: ControlSettings) -> None:
    link = watch_link(REMOTE, NO_LINK, control)
    assert link.lease_ticks == control.lease_ticks == 125.0
    link = watch_link(REMOTE._replace(age_ticks=50.0), link, control)
    assert link.lease_ticks == 124.0
    link = watch_link(REMOTE._replace(speed_mps=math.inf), link, control)
    assert link.lease_ticks == 123.0
    link = watch_link(REMOTE._replace(refused=9.0), link, control)
    assert link.lease_ticks == 122.0
    for _ in range(200):
        link = watch_link(REMOTE._replace(age_ticks=NEVER_TICKS), link, control)
    assert link.lease_ticks == 0.0
