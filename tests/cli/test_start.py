"""Without the wheel a person is asked: on a display by a page, in a terminal by lines; nobody is as before."""

import io
import os
import subprocess
import sys
from functools import partial
from pathlib import Path

import pytest

from simconsole.cli.start import ask, chosen, offered
from simconsole.recording.bundles.bundle import LOG, open_bundle
from simconsole.recording.bundles.replay_bundle import recorded_session
from simconsole.session.resolution import load_session, resolve
from tests.hud.window.x_server import hands, x_server
from tests.patience import PATIENCE_S, wait_until

SEATED = load_session("seated")
NO_DISPLAY = ("DISPLAY", "WAYLAND_DISPLAY")


SESSION = """\
schema: 1
title: To be driven by keys
environment: {world: urban}
scenario: {vehicle: hatchback}
outputs: {hud: {width_px: 800, height_px: 600}, scene: null, report: false}
devices: {driver: sdl, cockpit: t500rs_th8rs}
mode: {pacing: realtime}
"""


@pytest.fixture
def no_display(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in NO_DISPLAY:
        monkeypatch.delenv(name, raising=False)


def test_the_page_says_what_is_connected_and_what_can_be_driven(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DISPLAY", ":0")
    monkeypatch.delenv("SDL_VIDEODRIVER", raising=False)
    found = offered(SEATED, "no wheel")
    by_name = dict(zip(found.cockpits, found.page.cockpits, strict=True))
    assert set(by_name) == {"keyboard", "gamepad", "g29", "t300rs_th8a", "t500rs_th8rs", "virtual"}
    assert found.cockpits[0] == "keyboard"
    assert by_name["keyboard"].possible
    assert (by_name["g29"].note, by_name["g29"].possible) == ("not connected", False)
    assert {"", "urban", "country", "motorway"} <= set(found.places)
    assert len(found.places) == len(found.page.places)


def test_keys_need_a_display(no_display: None) -> None:
    found = offered(SEATED, "")
    keyboard = found.page.cockpits[found.cockpits.index("keyboard")]
    assert (keyboard.note, keyboard.possible) == ("needs a display", False)


@pytest.mark.parametrize("world", ["", "country"])
@pytest.mark.parametrize("cockpit", ["keyboard", "gamepad", "virtual"])
def test_every_choice_is_a_session_that_resolves(cockpit: str, world: str) -> None:
    session = chosen(SEATED, cockpit, world)
    resolve(session)
    assert session.environment.world == (world or SEATED.environment.world)
    assert session.devices.driver == {"gamepad": "sdl"}.get(cockpit, cockpit)
    assert session.features.control.manual_automatic == (cockpit == "keyboard")


def test_a_robot_is_offered_arenas_and_a_car_is_not() -> None:
    robot, car = offered(load_session("turtlebot3_burger"), ""), offered(SEATED, "")
    assert robot.places == ("", "arena")
    assert "urban" in car.places
    assert "arena" not in car.places


@pytest.mark.parametrize(
    ("typed", "driver", "world"),
    [
        ("\n\n", "virtual", "urban"),
        ("6\n2\n", "virtual", "country"),
        ("1\n", None, None),
        ("q\n", None, None),
        ("", None, None),
    ],
)
def test_a_terminal_is_asked_line_by_line(
    typed: str,
    driver: str | None,
    world: str | None,
    no_display: None,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(sys, "stdin", io.StringIO(typed))
    session = ask(SEATED, "no wheel")
    assert (session and session.devices.driver, session and session.environment.world) == (driver, world)
    told = capsys.readouterr().err
    assert "no wheel" in told
    assert " -  Keyboard (needs a display)" in told


def test_without_a_wheel_a_display_offers_the_keyboard_and_drives(tmp_path: Path) -> None:
    """The whole way, by a person's hands on a real X server: Return, the brake, into gear, the throttle held, End."""
    bundle = tmp_path / "bundle"
    session = tmp_path / "session.yaml"
    session.write_text(SESSION)
    with x_server() as display:
        kept = {name: value for name, value in os.environ.items() if name not in (*NO_DISPLAY, "SDL_VIDEODRIVER")}
        environment = {**kept, "DISPLAY": display, "XDG_STATE_HOME": str(tmp_path)}
        command = [sys.executable, "-m", "simconsole", "drive", str(session), "--out", str(bundle), "--no-pack"]
        with subprocess.Popen(command, env=environment, stderr=subprocess.PIPE, text=True) as program:

            def turn_and(*words: str) -> bool:
                turned_to_the_window(display, *words)
                assert program.poll() is None, "the drive has ended"
                return True

            try:
                wait_until(lambda: turn_and("key", "Return") and (bundle / LOG).exists(), "a log")
                wait_until(lambda: turn_and("keydown", "s") and newest(bundle, "driver.brake") == 1.0, "the brake")
                # A gear is asked for once only: each further press would be a gear more.
                hands(display, "keyup", "s", "key", "e")
                far = partial(newest, bundle, "vehicle.distance_m")
                wait_until(lambda: turn_and("keydown", "w") and far() > 1.0, "the car moves")
                hands(display, "keyup", "w")
                wait_until(lambda: turned_to_the_window(display, "key", "End") and program.poll() is not None, "End")
                _, told = program.communicate(timeout=PATIENCE_S)
            finally:
                program.kill()
    assert program.returncode == 0, told
    driven = open_bundle(bundle)
    assert recorded_session(driven).session.devices.driver == "keyboard"
    assert driven.log.table().column("driver.throttle").max() == 1.0
    assert driven.log.table().column("vehicle.distance_m")[-1] > 1.0


def newest(bundle: Path, column: str) -> float:
    """Return a column's value in the newest tick on the disk, 0.0 while there is none."""
    vectors = open_bundle(bundle).log.table((column,)).vectors
    return float(vectors[-1, 0]) if len(vectors) else 0.0


def turned_to_the_window(display: str, *words: str) -> bool:
    """Turn to the window that there is now, if any, as somebody does who sees that it does not answer yet.

    The page gives way to the driver's view, and SDL may put another window in the place of its first.
    """
    hands(display, "search", "--onlyvisible", "--class", ".", "windowfocus", *words, sure=False)
    return True
