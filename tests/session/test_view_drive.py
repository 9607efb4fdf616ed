"""A paced drive with the road in its window: drawn by real OpenGL, or, where there is none, without it."""

import json
import os
import signal
from pathlib import Path

from simconsole.processes.supervisor import STATUS
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.verification import verify
from simconsole.session.worker_programs import LATENCY
from tests.drives.console import Running
from tests.patience import PATIENCE_S, wait_until

SESSION = """\
schema: 1
title: The road in the window
environment: {world: WORLD}
scenario: {vehicle: VEHICLE}
outputs:
  bridge: null
  hud: {width_px: 320, height_px: 240, rate_hz: 10, view: {}}
  scene: null
  report: false
devices: {driver: "none"}
mode: {pacing: realtime, tick_hz: 250}
"""


def shown(core: int, name: str) -> Path | None:
    """A file of the drive's run folder, if it is there."""
    return next(Path("/dev/shm").glob(f"simconsole-{core}-*/{name}"), None)


def has_drawn(core: int) -> bool:
    """Whether the window has told how long it drew."""
    told = shown(core, f"{LATENCY}.hud.json")
    return told is not None and "draw" in json.loads(told.read_bytes())


def driven(folder: Path, display: str, world: str = "urban", vehicle: str = "hatchback") -> tuple[Path, str]:
    """Drive until a window has told of its pictures; return the bundle and what was said on standard error."""
    session = folder / "session.yaml"
    session.write_text(SESSION.replace("WORLD", world).replace("VEHICLE", vehicle))
    words = ("drive", session, "--for", 600, "--out", folder / "bundle", "--no-pack", "--json")
    with Running(folder / "run", *words, SDL_VIDEODRIVER=display) as drive:
        wait_until(lambda: has_drawn(drive.process.pid), "a picture")
        drive.process.send_signal(signal.SIGINT)
        assert drive.end().returncode == 130
    return folder / "bundle", drive.err.read_text("utf-8")


def test_the_window_draws_a_ball_on_nothing_while_the_drive_goes_on(tmp_path: Path) -> None:
    bundle, said = driven(tmp_path, "offscreen", "null", "ball")
    summary = open_bundle(bundle).manifest.summary
    assert {"receive, hud", "draw, hud"} <= set(summary["latency_us"])
    assert verify(bundle) == []
    assert "Traceback" not in said
    assert said.count("driver's view:") <= 1, "told once, and only where the processor draws"


def test_a_view_of_a_town_that_is_killed_is_shown_again_while_the_drive_goes_on(tmp_path: Path) -> None:
    session = tmp_path / "session.yaml"
    session.write_text(SESSION.replace("WORLD", "urban").replace("VEHICLE", "hatchback"))
    words = ("drive", session, "--for", 600, "--out", tmp_path / "bundle", "--no-pack", "--json")
    with Running(tmp_path / "run", *words, SDL_VIDEODRIVER="offscreen") as drive:
        core = drive.process.pid
        wait_until(lambda: shown(core, f"{LATENCY}.hud.json"), "a picture")
        status, drawn = shown(core, STATUS), shown(core, f"{LATENCY}.hud.json")
        assert status is not None
        assert drawn is not None
        process = json.loads(status.read_bytes())["hud"]["process_id"]
        drawn.unlink()
        os.kill(process, signal.SIGKILL)
        wait_until(lambda: json.loads(status.read_bytes())["hud"]["restarts"] == 1, "another view")
        wait_until(lambda: has_drawn(core), "a picture of the other view")
        drive.process.send_signal(signal.SIGINT)
        assert drive.process.wait(PATIENCE_S) == 130
    summary = open_bundle(tmp_path / "bundle").manifest.summary
    assert summary["worker_restarts"]["hud"] == 1
    assert {"receive, hud", "draw, hud"} <= set(summary["latency_us"])
    assert verify(tmp_path / "bundle") == []
    said = drive.err.read_text("utf-8")
    assert "Traceback" not in said
    assert said.count("driver's view:") <= 2, "each view tells once, and only where the processor draws"


def test_without_opengl_the_drive_shows_its_instruments(tmp_path: Path) -> None:
    bundle, said = driven(tmp_path, "dummy", "null", "ball")
    assert said.count("the instruments are shown without the road") == 1
    assert "Traceback" not in said
    assert verify(bundle) == []
