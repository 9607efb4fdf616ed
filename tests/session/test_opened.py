from contextlib import ExitStack
from typing import Any, cast

import pytest

from simconsole.bridge.link.delay import CommandsOverLink
from simconsole.session import opened
from simconsole.session.opened import commands_over_link, outputs_of, summary_of, traffic_of
from simconsole.session.resolution import load_session, override, resolve
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.protocols import NobodyCommands


class Console:
    """As much of a console as is looked at."""

    tick_hz = 250


CONSOLE: Any = Console()


class Others:
    """Road users that know whether they were closed."""

    closed = False

    def close(self) -> None:
        self.closed = True

    def summary(self) -> dict[str, int]:
        return {"road_users": 3}


def with_bridge(bridge: dict[str, object] | None) -> ResolvedSession:
    session = override(load_session("roll_a_ball"), features={"autopilot": None}, outputs={"bridge": bridge})
    return resolve(session)


def test_commands_are_late_only_over_a_link_that_delays_or_loses_them() -> None:
    source = NobodyCommands()
    assert commands_over_link(source, with_bridge(None), CONSOLE) is source
    noisy: dict[str, object] = {"link": {"localisation": {"speed_noise_mps": 1.0}}}
    assert commands_over_link(source, with_bridge(noisy), CONSOLE) is source
    late: dict[str, object] = {"link": {"delay_ms": 40.0}}
    assert isinstance(commands_over_link(source, with_bridge(late), CONSOLE), CommandsOverLink)


def test_road_users_are_told_of_ticks_and_closed_with_the_drive(monkeypatch: pytest.MonkeyPatch) -> None:
    others: Any = Others()
    monkeypatch.setattr(opened, "open_traffic", lambda resolved, console, folder: others)
    with ExitStack() as stack:
        traffic = traffic_of(cast("Any", None), CONSOLE, stack)
        assert outputs_of(traffic) == (others,)
        assert summary_of(traffic) == {"road_users": 3}
        assert not others.closed
    assert others.closed


def test_an_empty_road_is_told_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(opened, "open_traffic", lambda resolved, console, folder: None)
    with ExitStack() as stack:
        traffic = traffic_of(cast("Any", None), CONSOLE, stack)
    assert (traffic, outputs_of(traffic), summary_of(traffic)) == (None, (), {})
