"""The page before a drive in a real window: keys choose, Return drives, Escape and closing leave."""

import json
import os
import subprocess
import sys
from collections.abc import Iterator

import pytest

from tests.hud.window.x_server import hands, x_server
from tests.patience import PATIENCE_S

PROGRAM = """
import json
from simconsole.hud.start_page import Offer, opened
from simconsole.hud.window.start_window import choose
from simconsole.profiles.view import HudProfile

cockpits = (Offer("wheel", "not connected", possible=False), Offer("keyboard"))
page = choose(opened(cockpits, (Offer("here"), Offer("there"))), HudProfile())
print(json.dumps(page and (page.cockpit, page.place)))
"""


@pytest.fixture(scope="module")
def server() -> Iterator[str]:
    with x_server() as name:
        yield name


@pytest.fixture
def display(server: str, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.delenv("SDL_VIDEODRIVER", raising=False)
    monkeypatch.setenv("DISPLAY", server)
    return server


def pressed(display: str, *keys: str) -> list[int] | None:
    """Choose, in a process of its own, with these keys pressed as soon as the window has the keyboard."""
    around = {**os.environ, "DISPLAY": display}
    with subprocess.Popen([sys.executable, "-c", PROGRAM], env=around, stdout=subprocess.PIPE, text=True) as shown:
        hands(display, "search", "--sync", "--onlyvisible", "--class", ".", "windowfocus", "--sync")
        hands(display, "key", "--delay", "60", *keys)
        told, _ = shown.communicate(timeout=PATIENCE_S)
    assert shown.returncode == 0
    found: list[int] | None = json.loads(told.splitlines()[-1])
    return found


def test_keys_choose_and_return_drives(display: str) -> None:
    assert pressed(display, "Down", "Right", "Down", "Return") == [1, 1]


def test_escape_leaves(display: str) -> None:
    assert pressed(display, "Escape") is None
