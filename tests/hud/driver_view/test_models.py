import math

import numpy as np
import pytest

from simconsole.hud.driver_view.models import WHEELS, moving_frames, vehicle_model, world_model
from simconsole.hud.driver_view.motion import ShownVehicle
from simconsole.hud.driver_view.scene import Part, world_parts
from simconsole.hud.driver_view.vehicle_body import WHEEL_RADIUS_M, Size, vehicle_meshes
from simconsole.profiles.files.loader import load
from simconsole.profiles.world import CourseProfile
from simconsole.world.course import Course
from simconsole.world.drawing import draw
from tests.hud.driver_view.test_gltf import read, triangles

CAR = Size(3.99, 1.75, 1.45, 0.75, 2.5)
ROBOT = Size(0.138, 0.178, 0.192, 0.101, 0.160)
BALL = Size(0.4, 0.4, 0.4, 0.2, 0.4)
MOST_BYTES = 1_000_000


def test_the_urban_course_is_complete_and_small(monkeypatch: pytest.MonkeyPatch) -> None:
    drawing = draw(Course(load("worlds", "urban", CourseProfile)))
    parts = world_parts(drawing, ((0.0, 50.0),))
    asked: list[object] = []

    def again(*given: object) -> tuple[Part, ...]:
        """Return the parts of this drawing, which take a second to make."""
        asked.extend(given[:2])
        return parts

    monkeypatch.setattr("simconsole.hud.driver_view.models.world_parts", again)
    data = world_model(drawing, ((0.0, 50.0),))
    assert asked[0] is drawing
    assert asked[1:] == [((0.0, 50.0),)]
    assert 4 * len(data) / 3 < MOST_BYTES
    content, binary = read(data)
    meshes = {node["name"]: node["mesh"] for node in content["nodes"] if "mesh" in node}
    layers = {node["name"]: node["extras"]["layer"] for node in content["nodes"] if "layer" in node.get("extras", {})}
    assert layers == {
        "land": 0,
        "verges": 1,
        "asphalt": 1,
        "islands": 2,
        "markings": 3,
        "crossings": 3,
        "stop_lines": 3,
    }
    for part in parts:
        if part.name == "verges":
            assert len(part.mesh) == 0  # a town has kerbs
            continue
        assert len(triangles(content, binary, meshes[part.name])) == len(part.mesh) // 3, part.name
    assert sum(name.startswith("signal_") for name in meshes) == 3 * len(drawing.lights) > 0


def test_without_a_world_there_is_a_plain() -> None:
    content, _ = read(world_model(None, ()))
    assert [node["name"] for node in content["nodes"]] == ["land", "grid", "map"]


def test_what_moves_stands_where_its_frame_has_it() -> None:
    content, binary = read(vehicle_model(CAR))
    nodes = {node["name"]: node for node in content["nodes"]}
    for frame in moving_frames(vehicle_meshes(CAR), 15.0, ShownVehicle())[1:]:
        assert nodes[frame.name]["translation"] == pytest.approx(frame.place_m), frame.name
    corners = triangles(content, binary, nodes["front_left_wheel"]["mesh"])
    assert np.abs(corners[:, :, 2]).max() == pytest.approx(WHEEL_RADIUS_M)
    assert nodes["base_link"]["extras"] == CAR._asdict()
    assert nodes["driver_eye"]["translation"] == pytest.approx(CAR.eye_m)
    assert {"body", "bonnet", "brake_lamps", "left_indicators", "right_indicators"} <= nodes.keys()


def test_wheels_roll_and_the_front_ones_steer() -> None:
    shown = ShownVehicle(x_m=1.0, y_m=2.0, z_m=3.0, yaw_rad=0.3, pitch_rad=0.2, roll_rad=0.1, road_wheel_rad=0.4)
    frames = {frame.name: frame for frame in moving_frames(vehicle_meshes(CAR), 15.0, shown._replace(distance_m=0.31))}
    assert tuple(frames) == ("base_link", *WHEELS, "hand_wheel")
    assert frames["base_link"] == ("map", "base_link", (1.0, 2.0, 3.0), (0.1, 0.2, 0.3))
    assert frames["front_right_wheel"].turn_rad == pytest.approx((0.0, 1.0, 0.4))
    assert frames["rear_left_wheel"].turn_rad == pytest.approx((0.0, 1.0, 0.0))
    assert frames["hand_wheel"].turn_rad[0] == pytest.approx(-6.0)
    assert all(frame.parent == "base_link" for name, frame in frames.items() if name != "base_link")
    far = moving_frames(vehicle_meshes(CAR), 15.0, shown._replace(distance_m=1e6))[1]
    assert abs(far.turn_rad[1]) <= math.pi


def test_a_ball_is_one_frame() -> None:
    assert [frame.name for frame in moving_frames(vehicle_meshes(BALL), 1.0, ShownVehicle())] == ["base_link"]
    content, _ = read(vehicle_model(BALL))
    assert [node["name"] for node in content["nodes"]] == ["body", "driver_eye", "base_link"]


def test_a_robot_has_two_wheels_that_roll_and_do_not_steer() -> None:
    shown = ShownVehicle(distance_m=0.033, road_wheel_rad=0.4)
    frames = moving_frames(vehicle_meshes(ROBOT), 10.0, shown)
    assert [frame.name for frame in frames] == ["base_link", "left_wheel", "right_wheel"]
    assert all(frame.turn_rad == pytest.approx((0.0, 1.0, 0.0)) for frame in frames[1:])
    content, _ = read(vehicle_model(ROBOT))
    nodes = {node["name"]: node for node in content["nodes"]}
    assert nodes.keys() == {"body", "driver_eye", "left_wheel", "right_wheel", "base_link"}
    for frame in frames[1:]:
        assert nodes[frame.name]["translation"] == pytest.approx(frame.place_m), frame.name
