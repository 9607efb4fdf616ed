"""SLAM and navigation as programs on the ROS side, against a real session in lockstep: map, then go to five targets."""

import math
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from simconsole.bridge.client.bridge_client import BridgeClient
from simconsole.drivers.robots.navigation.mission import Mission, Target
from simconsole.drivers.robots.navigation.navigator import Navigator
from simconsole.drivers.robots.nodes import navigation_node, slam_node
from simconsole.drivers.robots.nodes.ros_messages import plain_pose
from simconsole.drivers.robots.slam.planar import composed
from simconsole.evaluation.metrics.map_errors import map_errors
from simconsole.evaluation.metrics.trajectory_errors import trajectory_errors
from simconsole.profiles.files.loader import profiles_folder
from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.world import ArenaProfile
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.values.host.jit import compiled
from simconsole.values.platform import Pose
from simconsole.world.arena.outlines import outlines_of
from tests.drivers.robots.arena_robot import burger
from tests.drives.console import Running
from tests.patience import PATIENCE_S
from tests.ports import free_port
from tests.samples import Sample
from tests.world.arena.shipped_arena import arena

FIRST = arena().starts[0]
START = Pose(FIRST.x_m, FIRST.y_m, math.radians(FIRST.yaw_deg))
TICK_HZ = 200
ACTION = "/tb3_0/navigate_to_pose"
ERRORS = "odometry: {distance_scale: 1.02, turn_scale: 1.03, slip_m_per_root_m: 0.002, seed: %d}\n"
COLUMNS = (
    *("vehicle.x_m", "vehicle.y_m", "vehicle.yaw_rad", "vehicle.distance_m", "platform.motion.collisions"),
    *("platform.odometry.x_m", "platform.odometry.y_m", "platform.odometry.yaw_rad"),
    *("command.target_speed_mps", "ros.refused"),
)
"""All columns of a whole drive are more than a process of the tests should hold."""
ROOMS = """schema: 1
kind: arena
title: Two rooms with a door between them
walls:
  - {closed: true, points: [{x_m: 0, y_m: 0}, {x_m: 3.6, y_m: 0}, {x_m: 3.6, y_m: 2.8}, {x_m: 0, y_m: 2.8}]}
  - {points: [{x_m: 1.9, y_m: 0}, {x_m: 1.9, y_m: 1.8}]}
pillars: [{x_m: 2.8, y_m: 1.4, radius_m: 0.15}]
starts: [{name: tb3_0, x_m: 0.8, y_m: 0.8, yaw_deg: 38.66}]
targets:
  - {name: A, x_m: 0.7, y_m: 2.2, yaw_deg: 90}
  - {name: B, x_m: 2.9, y_m: 2.2, yaw_deg: 0}
  - {name: C, x_m: 3.0, y_m: 0.6, yaw_deg: -90}
  - {name: D, x_m: 2.4, y_m: 0.7, yaw_deg: 180}
  - {name: E, x_m: 1.4, y_m: 0.7, yaw_deg: 0}
"""
"""What is behind the wall has to be explored, and a mission takes 66 s. The shipped arena is explored and driven in the
sample too, without a console: tests/drivers/robots/navigation/test_mission.py."""


def targets_of(world: ArenaProfile) -> list[Target]:
    return [Target(spot.name, spot.x_m, spot.y_m, math.radians(spot.yaw_deg)) for spot in world.targets]


class Driven:
    """One drive: what both programs made of it, and what is left of it."""

    def __init__(self, folder: Path, seed: int, duration_s: float, namespace: str = "", rooms: bool = False) -> None:
        self.bundle, self.seed = folder / "bundle", seed
        if rooms:
            (folder / "rooms.world.yaml").write_text(ROOMS)
        self.world = str(folder / "rooms.world.yaml") if rooms else "arena"
        profile = load_world(self.world)
        assert isinstance(profile, ArenaProfile)
        self.arena = profile
        self.mapped: slam_node.Mapped | None = None
        self.navigated: navigation_node.Navigated | None = None
        self.url = f"ws://127.0.0.1:{free_port()}"
        session = self._session(folder, seed, duration_s, namespace)
        with Running(folder, "drive", session, "--out", self.bundle, "--json", "--no-pack") as console:
            self._run(namespace)
            done = console.end()
        assert done.returncode == 0, done.stderr
        self.table = open_bundle(self.bundle).log.table(COLUMNS)

    def _session(self, folder: Path, seed: int, duration_s: float, namespace: str) -> Path:
        profiles, vehicle, session = profiles_folder(), folder / "robot.yaml", folder / "session.yaml"
        vehicle.write_text((profiles / "vehicles" / "turtlebot3_burger.yaml").read_text() + ERRORS % (seed + 1))
        shipped = (profiles / "sessions" / "turtlebot3_burger.yaml").read_text()
        bridge = f"port: {self.url.rpartition(':')[2]}\n    namespace: '{namespace}'\n    link: {{seed: {seed}}}"
        session.write_text(
            shipped.replace("port: 9090", bridge)
            .replace("world: arena", f"world: {self.world}")
            .replace("hud: null", "hud: null\n  scene: null\n  report: false")
            .replace("duration_s: 60", f"duration_s: {duration_s}")
            .replace("vehicle: turtlebot3_burger", f"vehicle: {vehicle}")
            .replace("control_period_ms: 20", "control_period_ms: 20\n  answer_timeout_s: 60")
        )
        return session

    def _run(self, namespace: str) -> None:
        listens = threading.Event()

        def map_it() -> None:
            self.mapped = slam_node.run(
                self.url,
                START,
                namespace=namespace,
                ready=listens.set,
                patience_s=PATIENCE_S,
                dead_after_s=math.inf,
            )

        slam = threading.Thread(target=map_it, name="slam", daemon=True)
        slam.start()
        assert listens.wait(PATIENCE_S)
        navigator = Navigator(burger(), compiled)
        self.navigated = navigation_node.run(
            self.url,
            navigator,
            self.mission(navigator),
            namespace=namespace,
            lockstep=True,
            patience_s=PATIENCE_S,
            dead_after_s=math.inf,
        )
        slam.join(PATIENCE_S)
        assert not slam.is_alive(), "it has not heard that the drive is over"

    def mission(self, navigator: Navigator) -> Mission | None:
        return Mission(navigator, targets_of(self.arena))

    def column(self, name: str) -> Any:
        return self.table.column(name)

    def poses(self, rows: Any, *names: str) -> Any:
        return np.column_stack([self.column(name)[rows] for name in names])


class Sent(Driven):
    """A drive under a namespace whose goals come by the action, from a third program; and what that was told."""

    goals = ((1.6, 1.4), (2.2, 3.4))

    def mission(self, navigator: Navigator) -> Mission | None:
        self.told: list[tuple[str, Any]] = []
        self.sender = threading.Thread(target=self._send, name="sender")
        self.sender.start()
        return None

    def _send(self) -> None:
        with BridgeClient(self.url, until_good_bye=True, dead_after_s=math.inf) as client:
            client.connect(PATIENCE_S)
            while ACTION not in self._served(client):
                client.receive(0.01)
            for x, y in self.goals:
                self._pursue(client, x, y)

    def _served(self, client: BridgeClient) -> list[str]:
        """The actions that somebody offers now."""
        answers: list[Any] = []
        client.call_service("/rosapi/action_servers", {}, lambda values, result: answers.append(values))
        while not answers:
            client.receive(0.1)
        return list(answers[0]["action_servers"])

    def _pursue(self, client: BridgeClient, x: float, y: float) -> None:
        ended: list[bool] = []

        def on_result(values: Any, result: bool) -> None:
            ended.append(result)
            self.told.append(("result", result))

        kind = "nav2_msgs/action/NavigateToPose"
        args = {"pose": {"header": {"frame_id": "map"}, "pose": plain_pose(Pose(x, y, 0.5))}}
        client.send_goal(ACTION, kind, args, on_result, lambda values: self.told.append(("feedback", values)))
        while not ended:
            client.receive(0.1)


@pytest.fixture(scope="module")
def driven(tmp_path_factory: pytest.TempPathFactory, module_sample: Sample) -> list[Driven]:
    """The sample is one drive through two rooms; the full size is twenty through the shipped arena."""
    folders = [tmp_path_factory.mktemp("mission") for _ in range(module_sample.of(1, 20))]
    return [
        Driven(folder, (module_sample.seed + number) % 10_000, module_sample.of(100, 360), rooms=not module_sample.long)
        for number, folder in enumerate(folders)
    ]


def test_all_targets_are_reached_without_touching_anything(driven: list[Driven]) -> None:
    for drive in driven:
        told = drive.navigated
        assert told is not None
        assert told.ended == "mission done"
        places = {target.name: target for target in targets_of(drive.arena)}
        assert sorted(visit.name for visit in told.visits) == list(places) == ["A", "B", "C", "D", "E"]
        x, y = drive.column("vehicle.x_m"), drive.column("vehicle.y_m")
        for visit in told.visits:
            assert visit.reached
            row = round(visit.time_s * TICK_HZ) - 1
            assert math.hypot(x[row] - places[visit.name].x_m, y[row] - places[visit.name].y_m) < 0.12
        assert drive.column("platform.motion.collisions")[-1] == 0.0
        assert (drive.column("ros.refused") == 0.0).all()
        assert least_room_m(drive.arena, x, y, drive.column("vehicle.yaw_rad")) >= 0.05
        assert told.explored_s is not None
        first, last = (round(second * TICK_HZ) - 1 for second in (told.explored_s, told.visits[-1].time_s))
        way = drive.column("vehicle.distance_m")
        print(f"explored {told.explored_s} s, planned {told.planned_m:.2f} m, driven {way[last] - way[first]:.2f} m")
        assert way[last] - way[first] <= 1.1 * told.planned_m


def test_slam_knows_where_it_is_and_what_stands_there(driven: list[Driven]) -> None:
    for drive in driven:
        assert drive.mapped is not None
        assert drive.mapped.grid is not None
        moments = drive.mapped.moments
        rows = np.array([round(moment.time_ns * TICK_HZ / 1e9) - 1 for moment in moments])
        true = drive.poses(rows, "vehicle.x_m", "vehicle.y_m", "vehicle.yaw_rad")
        errors = trajectory_errors(np.array([moment.pose for moment in moments]), true, 5)
        told = drive.poses(rows, *(f"platform.odometry.{name}" for name in ("x_m", "y_m", "yaw_rad")))
        raw = trajectory_errors(np.array([composed(START, Pose(*pose)) for pose in told.tolist()]), true, 5)
        walls = map_errors(drive.mapped.grid, outlines_of(drive.arena))
        print(f"{errors}\nraw odometry {raw}\n{walls}")
        assert errors.absolute_rms_m <= 0.05
        assert raw.absolute_rms_m > 3.0 * errors.absolute_rms_m
        assert walls.precision >= 0.85
        assert walls.recall >= 0.85


def test_it_replays(driven: list[Driven]) -> None:
    found = replay_bundle(driven[0].bundle)
    assert found.hashes_equal, found.differences


def test_two_drives_of_one_seed_are_equal(driven: list[Driven], tmp_path: Path) -> None:
    """Whichever of both programs is faster."""
    seconds = 10
    again = Driven(tmp_path, driven[0].seed, seconds, rooms=driven[0].world != "arena")
    for column in ("vehicle.x_m", "vehicle.yaw_rad", "platform.odometry.x_m", "command.target_speed_mps"):
        found = again.column(column)
        assert len(found) == seconds * TICK_HZ
        assert (found == driven[0].column(column)[: len(found)]).all()


def test_goals_by_action_are_driven_to_under_a_namespace(tmp_path: Path) -> None:
    drive = Sent(tmp_path, 3, 40, "/tb3_0")
    drive.sender.join(PATIENCE_S)
    results = [told for kind, told in drive.told if kind == "result"]
    assert results == [True, True]
    feedback = [told for kind, told in drive.told if kind == "feedback"]
    left = [told["distance_remaining"] for told in feedback[:4]]
    assert left[-1] < left[0]
    x, y = drive.column("vehicle.x_m"), drive.column("vehicle.y_m")
    for goal in drive.goals:
        assert np.hypot(x - goal[0], y - goal[1]).min() < 0.1
    assert drive.column("platform.motion.collisions")[-1] == 0.0


def least_room_m(world: ArenaProfile, x: Any, y: Any, yaw: Any) -> float:
    """The least distance from the edge of the body to an obstacle, every tenth tick."""
    shape, outlines = burger(), outlines_of(world)
    x, y, yaw = x[::10], y[::10], yaw[::10]
    places = np.column_stack((x + shape.body_x_m * np.cos(yaw), y + shape.body_x_m * np.sin(yaw)))
    least = math.inf
    for ax, ay, bx, by in outlines.segments.tolist():
        way = np.array((bx - ax, by - ay))
        share = np.clip((places - (ax, ay)) @ way / (way @ way), 0.0, 1.0)
        least = min(least, float(np.hypot(*(places - (ax, ay) - share[:, None] * way).T).min()))
    for cx, cy, radius in outlines.circles.tolist():
        least = min(least, float(np.hypot(places[:, 0] - cx, places[:, 1] - cy).min()) - radius)
    return least - shape.radius_m
