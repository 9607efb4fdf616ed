"""`simconsole autopilot`: what a user can do wrong."""

import math
import os
from argparse import Namespace
from typing import Any

import pytest

from simconsole.cli import remote
from simconsole.cli.remote import autopilot, own_token
from simconsole.drivers.autopilot import rosbridge_autopilot as program
from simconsole.processes.lifetimes import Parent
from simconsole.session.autopilot_program import TOKEN_VARIABLE
from simconsole.values.errors import ProfileError
from tests.drives.console import complaint, simconsole


def test_autopilot_against_nobody_is_one_line() -> None:
    line = complaint(simconsole("autopilot", "--url", "ws://127.0.0.1:9", "--wait", 0.1))
    assert "ws://127.0.0.1:9: cannot connect: " in line


def test_autopilot_on_an_unknown_course_is_one_line() -> None:
    line = complaint(simconsole("autopilot", "--url", "ws://127.0.0.1:9", "--course", "moon"))
    assert "worlds profile: value 'moon'" in line


@pytest.mark.parametrize("word", ["/odom", "/odom=", "odom=/o", "/odom=o", "=/o"])
def test_rename_that_is_none_is_refused_before_anything_is_opened(word: str) -> None:
    options = Namespace(attached=False, url="ws://127.0.0.1:9", course="urban", namespace="", rename=[word])
    options.wait, options.certificate = 0.0, None
    with pytest.raises(ProfileError, match=f"--rename: {word}: expected /TOPIC=/NAME"):
        autopilot(options)


@pytest.mark.parametrize(("attached", "dead_after_s"), [(True, math.inf), (False, 3.0)])
def test_a_console_that_is_held_up_keeps_the_autopilot_that_it_has_started(
    attached: bool, dead_after_s: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is told of the console's end by its pipe."""
    told: dict[str, Any] = {}
    monkeypatch.setattr(program, "run", lambda *arguments, **words: told.update(words) or {})
    monkeypatch.setattr(remote, "follow_parent", lambda patience_s: Parent())
    options = Namespace(attached=attached, url="ws://127.0.0.1:9", course="urban", namespace="", rename=[], wait=0.0)
    options.certificate, options.vehicle, options.delay_ms, options.tracker = None, "hatchback", 0.0, "stanley"
    options.lateral_accel, options.lateral_jerk, options.plan_hz, options.speed_advice = 5.0, 2.0, 4.0, attached
    autopilot(options)
    assert (told["gate"], told["plan_hz"], told["speed_advice"]) == ((5.0, 2.0), 4.0, attached)
    assert told["dead_after_s"] == dead_after_s


def test_token_is_taken_out_of_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    """What this program starts shall not have it."""
    monkeypatch.setenv(TOKEN_VARIABLE, "secret")
    assert own_token() == "secret"
    assert TOKEN_VARIABLE not in os.environ
    assert own_token() is None
