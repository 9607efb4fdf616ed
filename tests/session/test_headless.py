"""What a drive in one process cannot be opened with. What it does once it is open is in tests/drives."""

from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest

from simconsole.processes.lifetimes import Interrupt
from simconsole.session.headless import lockstep_link, open_headless
from simconsole.session.lockstep import LockstepLink
from simconsole.session.resolution import load_session, override, resolve
from simconsole.tick.assembly import ResolvedSession, assemble
from simconsole.values.errors import ProfileError
from simconsole.values.host.jit import plain

NOBODY: Any = None


def ball(**changes: dict[str, object]) -> ResolvedSession:
    outputs: dict[str, object] = {"bridge": None, "hud": None, "scene": None, "report": False}
    session = override(load_session("roll_a_ball"), features={"autopilot": None}, outputs=outputs)
    return resolve(override(session, **changes))


def opened(resolved: ResolvedSession, link: LockstepLink | None = None) -> None:
    """Open a drive that ends before it has a log."""
    console = assemble(resolved, plain)[0]
    with ExitStack() as stack:
        open_headless(resolved, console, NOBODY, Path(), Interrupt(), stack, link=link)


def test_lockstep_needs_a_bridge() -> None:
    with pytest.raises(
        ProfileError, match=r"^outputs\.bridge: value missing: a bridge, where mode\.pacing is lockstep$"
    ):
        opened(ball(mode={"pacing": "lockstep"}))


def test_a_named_controller_drives_no_platform_of_several() -> None:
    link = lockstep_link(NOBODY, ball().session, NOBODY)
    with pytest.raises(ProfileError, match=r"^features\.controller: .*: it drives one vehicle$"):
        opened(ball(mode={"pacing": "lockstep"}, features={"controller": {"name": "quick"}}), link)
