import math

import pytest

from simconsole.control.link import Link, watch_link
from simconsole.control.settings import ControlSettings
from simconsole.signals import NEVER_TICKS, ArbiterMemory, RemoteCommand, RemoteKind

MEMORY = ArbiterMemory(*(0.0,) * len(ArbiterMemory._fields))
REMOTE = RemoteCommand(*(0.0,) * len(RemoteCommand._fields))._replace(kind=float(RemoteKind.SPEED), sequence=1.0)


def memory(link: Link) -> ArbiterMemory:
    return MEMORY._replace(
        **{name: getattr(link, name) for name in ("sequence_seen", "refused_seen", "invalid_run", "fresh_ticks")}
    )


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
    link = watch_link(REMOTE._replace(**fields), MEMORY, control)
    assert (link.fresh, link.fresh_ticks, link.invalid) == (fresh, fresh, 0.0)


def test_refused_commands_count_in_a_row(control: ControlSettings) -> None:
    link = watch_link(REMOTE, MEMORY, control)
    for refused in range(1, 6):
        link = watch_link(REMOTE._replace(refused=float(refused)), memory(link), control)
        assert (link.invalid_run, link.fresh_ticks) == (float(refused), 0.0)
        assert link.invalid == (1.0 if refused == 5 else 0.0)
    link = watch_link(REMOTE._replace(refused=5.0, sequence=2.0), memory(link), control)
    assert (link.invalid_run, link.invalid, link.fresh_ticks) == (0.0, 0.0, 1.0)


def test_many_refused_in_one_tick_count_at_once(control: ControlSettings) -> None:
    link = watch_link(REMOTE, MEMORY, control)
    assert watch_link(REMOTE._replace(refused=5.0), memory(link), control).invalid == 1.0
    huge = watch_link(REMOTE._replace(refused=1e308), memory(link), control)
    assert (huge.invalid_run, huge.invalid) == (1e9, 1.0)


def test_a_counter_that_starts_anew_is_no_refusal(control: ControlSettings) -> None:
    link = watch_link(REMOTE._replace(refused=0.0), MEMORY._replace(refused_seen=7.0, sequence_seen=1.0), control)
    assert (link.refused_seen, link.invalid_run, link.fresh) == (0.0, 0.0, 1.0)


def test_a_command_that_is_no_number_is_invalid_and_remembered_as_nothing(control: ControlSettings) -> None:
    before = MEMORY._replace(sequence_seen=3.0, refused_seen=2.0, invalid_run=1.0, fresh_ticks=99.0)
    for field in ("sequence", "refused", "speed_mps"):
        assert watch_link(REMOTE._replace(**{field: math.nan}), before, control) == (3.0, 2.0, 1.0, 0.0, 0.0, 1.0)
