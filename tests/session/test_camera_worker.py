"""A camera's pictures from a real drive over a real WebSocket."""

import base64
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from simconsole.profiles.files.world_files import load_world
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.world.kinds.worlds import open_world
from tests.drives.console import complaint, simconsole
from tests.hud.gl.test_camera_picture import decoded
from tests.interop.programs import Client, client, environment, program, wait_for_port
from tests.ports import free_port

SESSION = """\
schema: 1
title: A camera on the car
environment: {{world: urban}}
scenario: {{vehicle: hatchback}}
outputs:
  bridge: {{port: {port}, camera: {{rate_hz: 5, width_px: 640, height_px: 480, z_m: 1.4, pitch_deg: 6}}}}
  hud: null
  scene: null
  report: false
devices: {{driver: "none"}}
mode: {{pacing: realtime, tick_hz: 250}}
"""
IMAGE, INFO = "/camera/image_raw/compressed", "/camera/camera_info"
SHOTS = 4


def session(folder: Path) -> tuple[Path, int]:
    port, path = free_port(), folder / "session.yaml"
    path.write_text(SESSION.format(port=port))
    return path, port


def ticks(header: dict[str, Any]) -> int:
    stamp = header["stamp"]
    seconds: float = stamp["sec"] + 1e-9 * stamp["nanosec"]
    return round(seconds * 250)


def heard(web: Client, topic: str, count: int) -> list[dict[str, Any]]:
    web.say(op="subscribe", topic=topic)
    found = [web.message(topic) for _ in range(count)]
    web.say(op="unsubscribe", topic=topic)
    return found


def turn(quaternion: dict[str, float]) -> np.ndarray:
    x, y, z, w = (quaternion[name] for name in "xyzw")
    return np.array(
        (
            (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
            (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
        )
    )


def test_pictures_of_a_drive_fit_the_road_by_their_camera_info(tmp_path: Path) -> None:
    """The white edge line of the lane, from the world's geometry through odometry, /tf_static and K to its pixels."""
    path, port = session(tmp_path)
    command = (
        sys.executable,
        "-m",
        "simconsole",
        "drive",
        str(path),
        "--out",
        str(tmp_path / "bundle"),
        "--for",
        "600",
    )
    with program(environment(), *command) as drive:
        wait_for_port(port)
        with client(f"ws://127.0.0.1:{port}") as web:
            (static,) = heard(web, "/tf_static", 1)
            (odometry,) = heard(web, "/odom", 1)
            infos, images = heard(web, INFO, SHOTS), heard(web, IMAGE, SHOTS)
        drive.terminate()
        drive.communicate(timeout=600.0)
    numbers = [ticks(image["header"]) for image in images]
    periods = [number // 50 for number in numbers]  # 5 Hz of 250 ticks: at most one picture in each period
    assert periods == sorted(set(periods))
    assert [part["header"]["frame_id"] for part in (*infos, *images)] == ["camera_optical"] * 2 * SHOTS
    mount = next(part["transform"] for part in static["transforms"] if part["child_frame_id"] == "camera_optical")
    pose = odometry["pose"]["pose"]
    picture = decoded(base64.b64decode(images[-1]["data"])).astype(int)
    assert picture.shape == (480, 640, 3)
    place, turned = (np.array([pose["position"][axis] for axis in "xyz"]), turn(pose["orientation"]))
    eye = place + turned @ np.array([mount["translation"][axis] for axis in "xyz"])
    axes = turned @ turn(mount["rotation"])
    k = np.array(infos[-1]["k"]).reshape(3, 3)
    seen = 0
    for edge in open_world(load_world("urban")).drawing.edges:
        points = (np.column_stack((edge, np.zeros(len(edge)))) - eye) @ axes
        pixels = (points[:, 2:] > 6.0) * 1.0 * (points @ k.T)
        for near, far, depth in zip(pixels[:-1], pixels[1:], points[:-1, 2], strict=True):
            if not 7.0 < depth < 16.0:
                continue
            (u, v), (u2, v2) = near[:2] / near[2], far[:2] / far[2]
            row = round(v)
            column = u + (u2 - u) * (row - v) / (v2 - v)
            if not (40.0 < column < 600.0 and 0 <= row < 480):
                continue
            first = round(column) - 25
            bright = np.flatnonzero(picture[row, first : first + 51].min(axis=1) > 210)  # paint, no kerb
            assert len(bright) > 0, (row, column)
            assert first + bright.mean() == pytest.approx(column, abs=1.0)
            seen += 1
    assert seen >= 4
    summary = open_bundle(tmp_path / "bundle").manifest.summary
    assert not summary["worker_restarts"].get("camera")


@pytest.mark.parametrize("pacing", ["lockstep", "free"])
def test_where_nobody_could_draw_it_a_camera_is_refused(pacing: str, tmp_path: Path) -> None:
    path, _ = session(tmp_path)
    path.write_text(path.read_text().replace("realtime", pacing))
    told = complaint(simconsole("drive", path, "--out", tmp_path / "bundle", "--for", 1))
    assert f"mode.pacing: value {pacing}: realtime, where outputs.bridge.camera is to be drawn" in told
