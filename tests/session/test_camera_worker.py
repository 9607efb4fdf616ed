"""A camera's pictures from a real drive over a real WebSocket."""

import base64
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from simconsole.profiles.bridge import CameraProfile
from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.parts.turtlebot import TurtlebotProfile
from simconsole.profiles.world import ArenaProfile
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.session.camera_worker import drawn_camera
from simconsole.session.resolution import load_session, resolve
from simconsole.session.view.view_job import view_job
from simconsole.tick.assembly import assemble
from simconsole.values.host.jit import plain
from simconsole.values.layout import write
from simconsole.values.platform import Pose
from simconsole.values.state_vector import LAYOUT, Snapshot
from simconsole.world.arena.depth_camera import DepthCamera
from simconsole.world.kinds.worlds import open_world
from simconsole.world.traffic.road_users import NOBODY_AT_ALL
from tests.drives.console import complaint, within
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
SHOTS = 3


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
        "--no-pack",
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
    told = complaint(within("drive", path, "--out", tmp_path / "bundle", "--for", 1))
    assert f"mode.pacing: value {pacing}: realtime, where outputs.bridge.camera is to be drawn" in told


def test_a_waffle_sees_in_colour_what_its_depth_camera_measures() -> None:
    """Where the floor ends below walls and pillars: by exact rays, and by the picture that EGL draws."""
    resolved = resolve(load_session("turtlebot3_waffle"))
    waffle, world = resolved.vehicle, resolved.world
    assert isinstance(waffle, TurtlebotProfile)
    assert waffle.depth_camera is not None
    assert isinstance(world, ArenaProfile)
    depth = waffle.depth_camera
    colour = CameraProfile(
        x_m=depth.x_m,
        z_m=depth.z_m,
        horizontal_fov_deg=depth.horizontal_fov_deg,
        width_px=depth.width_px,
        height_px=depth.height_px,
    )
    draw, measured = drawn_camera(view_job(resolved), colour), DepthCamera(depth, world, 0.2, plain)
    console, state = assemble(resolved, plain)
    snapshot = Snapshot(0, console.tick_hz, state.vector)
    for yaw_rad in (snapshot.vehicle.yaw_rad, 0.0, 1.5):
        turned = state.vector.copy()
        write(turned, LAYOUT.vehicle, snapshot.vehicle._replace(yaw_rad=yaw_rad))
        picture = decoded(draw(Snapshot(0, console.tick_hz, turned), NOBODY_AT_ALL)).astype(int)
        metres = measured.image(Pose(snapshot.vehicle.x_m, snapshot.vehicle.y_m, yaw_rad))
        off = []
        for at in range(depth.width_px):
            upwards = metres[::-1, at]
            rows = np.flatnonzero((upwards[1:] == upwards[:-1]) & np.isfinite(upwards[1:]))  # a wall stands upright
            if len(rows):  # else the wall is further than it measures
                differs = np.abs(picture[:, at] - picture[-1, at]).max(axis=1) > 12  # from the floor before the robot
                off.append(int(np.flatnonzero(differs)[-1]) - (depth.height_px - 1 - int(rows[0])))
        assert len(off) > 80, "in half of the columns or more"
        assert max(map(abs, off)) <= 3, "blocks of JPEG are 8 pixels"
        assert np.median(np.abs(off)) <= 1.0
