"""A paced drive with the road in its window: drawn by real OpenGL, or, where there is none, without it."""

from pathlib import Path

import pytest

from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.verification import verify
from tests.drives.console import results, simconsole

SESSION = """\
schema: 1
title: The road in the window
environment: {world: WORLD}
scenario: {vehicle: VEHICLE}
outputs:
  bridge: null
  hud: {width_px: 640, height_px: 480, rate_hz: 20, view: {}}
  scene: null
  report: false
devices: {driver: "none"}
mode: {pacing: realtime, tick_hz: 250}
"""


def driven(folder: Path, display: str, world: str = "urban", vehicle: str = "hatchback") -> tuple[Path, str]:
    """Drive a few seconds; return the bundle and what was said on standard error."""
    session = folder / "session.yaml"
    session.write_text(SESSION.replace("WORLD", world).replace("VEHICLE", vehicle))
    words = ("--for", 12, "--out", folder / "bundle", "--json")
    done = simconsole("drive", session, *words, SDL_VIDEODRIVER=display)
    assert done.returncode == 0, done.stderr
    assert results(done)["ticks"] == 12 * 250
    return folder / "bundle", done.stderr


@pytest.mark.parametrize(("world", "vehicle"), [("urban", "hatchback"), ("null", "ball")])
def test_the_window_draws_while_the_drive_goes_on(tmp_path: Path, world: str, vehicle: str) -> None:
    bundle, said = driven(tmp_path, "offscreen", world, vehicle)
    summary = open_bundle(bundle).manifest.summary
    assert {"receive, hud", "draw, hud"} <= set(summary["latency_us"])
    assert verify(bundle) == []
    assert "Traceback" not in said
    assert said.count("driver's view:") <= 1, "told once, and only where the processor draws"


def test_without_opengl_the_drive_shows_its_instruments(tmp_path: Path) -> None:
    bundle, said = driven(tmp_path, "dummy")
    assert said.count("the instruments are shown without the road") == 1
    assert "Traceback" not in said
    assert verify(bundle) == []
