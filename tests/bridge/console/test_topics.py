import math
from collections.abc import Callable
from typing import Any

import pytest

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.console.published_tick import ONCE, quaternion
from simconsole.bridge.console.topics import VELOCITY, is_due
from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.link import LinkProfile, LocalisationProfile
from simconsole.values.signals import NEVER_TICKS, Event, Mode, Reason
from tests.bridge.fixtures import Peer

TYPES = {
    "/clock": "rosgraph_msgs/Clock",
    "/tf": "tf2_msgs/TFMessage",
    "/odom": "nav_msgs/Odometry",
    "/ground_truth/odom": "nav_msgs/Odometry",
    "/console/joy": "sensor_msgs/Joy",
    "/console/arbitration": "simconsole_msgs/Arbitration",
    "/vehicle/status/velocity_status": "autoware_vehicle_msgs/VelocityReport",
    "/vehicle/status/steering_status": "autoware_vehicle_msgs/SteeringReport",
    "/vehicle/status/gear_status": "autoware_vehicle_msgs/GearReport",
    "/vehicle/status/turn_indicators_status": "autoware_vehicle_msgs/TurnIndicatorsReport",
    "/vehicle/status/hazard_lights_status": "autoware_vehicle_msgs/HazardLightsReport",
    "/vehicle/status/control_mode": "autoware_vehicle_msgs/ControlModeReport",
}


@pytest.fixture
def publish(peer: Any, snapshot: Callable[..., Any]) -> Callable[..., dict[str, Any]]:
    """All messages of one snapshot (at 1.5 s, when everything is due), by topic."""
    for topic, kind in TYPES.items():
        assert peer.send(op="subscribe", topic=topic, type=kind).kind == "done"

    def make(tick: int = 375, **fields: float) -> dict[str, Any]:
        peer.bridge.publish(snapshot(tick - 250), 0)
        peer.heard()
        peer.bridge.publish(snapshot(tick, **fields), 0)
        return {message["topic"]: message["msg"] for message in peer.heard()}

    return make


def test_every_topic_of_the_table_is_published_and_stamped(publish: Callable[..., dict[str, Any]]) -> None:
    messages = publish()
    assert set(messages) == set(TYPES)
    stamp = {"sec": 1, "nanosec": 500_000_000}
    assert messages["/clock"]["clock"] == stamp
    for topic in ("/odom", "/console/joy", "/console/arbitration", "/vehicle/status/velocity_status"):
        assert messages[topic]["header"]["stamp"] == stamp
    for topic in ("steering_status", "gear_status", "control_mode", "turn_indicators_status", "hazard_lights_status"):
        assert messages[f"/vehicle/status/{topic}"]["stamp"] == stamp


def test_odometry_comes_last(publish: Callable[..., dict[str, Any]]) -> None:
    assert list(publish())[-1] == "/odom"


def test_odometry_says_pose_in_the_world_and_twist_in_the_vehicle(publish: Callable[..., dict[str, Any]]) -> None:
    messages = publish(x_m=1.0, y_m=2.0, z_m=3.0, yaw_rad=math.pi / 2, vx_mps=4.0, vy_mps=0.5, yaw_rate_radps=0.25)
    odometry = messages["/odom"]
    assert (odometry["header"]["frame_id"], odometry["child_frame_id"]) == ("odom", "base_link")
    assert odometry["pose"]["pose"]["position"] == {"x": 1.0, "y": 2.0, "z": 3.0}
    orientation = odometry["pose"]["pose"]["orientation"]
    assert orientation == pytest.approx({"x": 0.0, "y": 0.0, "z": math.sqrt(0.5), "w": math.sqrt(0.5)})
    assert odometry["twist"]["twist"]["linear"] == {"x": 4.0, "y": 0.5, "z": 0.0}
    assert odometry["twist"]["twist"]["angular"] == {"x": 0.0, "y": 0.0, "z": 0.25}
    assert messages["/ground_truth/odom"]["header"]["frame_id"] == "map"
    (transform,) = messages["/tf"]["transforms"]
    assert (transform["header"]["frame_id"], transform["child_frame_id"]) == ("odom", "base_link")
    assert transform["transform"] == {"translation": {"x": 1.0, "y": 2.0, "z": 3.0}, "rotation": orientation}


def test_map_and_odom_coincide_for_whoever_comes_late(peer: Any, snapshot: Callable[..., Any]) -> None:
    peer.bridge.publish(snapshot(1), 0)
    peer.bridge.publish(snapshot(2), 0)
    peer.send(op="subscribe", topic="/tf_static", type="tf2_msgs/TFMessage")
    (message,) = peer.heard()
    (transform,) = message["msg"]["transforms"]
    assert (transform["header"]["frame_id"], transform["child_frame_id"]) == ("map", "odom")
    assert transform["transform"]["rotation"]["w"] == 1.0


def test_joy_is_the_cockpit_as_read(publish: Callable[..., dict[str, Any]]) -> None:
    joy = publish(wheel_axis=-0.5, throttle_axis=0.25, hat_x=1.0, hat_y=-1.0, wheel_buttons=5.0, shifter_buttons=128.0)[
        "/console/joy"
    ]
    assert joy["axes"] == [-0.5, 0.25, 0.0, 0.0, 0.0, 1.0, -1.0]
    assert [index for index, pressed in enumerate(joy["buttons"]) if pressed] == [0, 2, 13 + 7]
    assert len(joy["buttons"]) == 23


@pytest.mark.parametrize(("gear", "report"), [(3.0, 2), (0.0, 1), (-1.0, 20)])
def test_status_reports(publish: Callable[..., dict[str, Any]], gear: float, report: int) -> None:
    messages = publish(vx_mps=4.0, vy_mps=0.5, yaw_rate_radps=0.25, gear=gear)
    velocity = messages["/vehicle/status/velocity_status"]
    assert (velocity["longitudinal_velocity"], velocity["lateral_velocity"], velocity["heading_rate"]) == (4, 0.5, 0.25)
    assert messages["/vehicle/status/gear_status"]["report"] == report


@pytest.mark.parametrize(
    ("mode", "lateral", "longitudinal", "report"),
    [
        (Mode.PARKED, 0.0, 0.0, 6),
        (Mode.MANUAL, 0.0, 0.0, 4),
        (Mode.AUTONOMOUS, 1.0, 1.0, 1),
        (Mode.TAKEOVER_REQUESTED, 1.0, 1.0, 1),
        (Mode.SHARED, 0.5, 0.5, 1),
        (Mode.SHARED, 0.5, 0.0, 2),
        (Mode.SHARED, 0.0, 0.5, 3),
        (Mode.SHARED, 0.0, 0.0, 4),
        (Mode.MINIMAL_RISK, 0.0, 0.0, 5),
        (Mode.STOPPED, 0.0, 0.0, 5),
        (Mode.EMERGENCY_STOP, 0.0, 0.0, 5),
    ],
)
def test_control_mode(
    publish: Callable[..., dict[str, Any]], mode: Mode, lateral: float, longitudinal: float, report: int
) -> None:
    messages = publish(mode=float(mode), remote_lateral=lateral, remote_longitudinal=longitudinal)
    assert messages["/vehicle/status/control_mode"]["mode"] == report


@pytest.mark.parametrize(
    ("turn_indicators", "hazard_lights", "reports"), [(0.0, 0.0, (1, 1)), (1.0, 0.0, (2, 1)), (-1.0, 1.0, (3, 2))]
)
def test_lights_are_reported_as_autoware_does(
    publish: Callable[..., dict[str, Any]], turn_indicators: float, hazard_lights: float, reports: tuple[int, int]
) -> None:
    messages = publish(turn_indicators=turn_indicators, hazard_lights=hazard_lights)
    status = [messages[f"/vehicle/status/{name}_status"]["report"] for name in ("turn_indicators", "hazard_lights")]
    assert tuple(status) == reports


def test_arbitration_is_told_in_numbers_and_words(publish: Callable[..., dict[str, Any]]) -> None:
    told = publish(
        mode=float(Mode.AUTONOMOUS), reason=float(Reason.PERSON_ASKED), remote_lateral=1.0, sequence=7.0, refused=2.0,
        age_ticks=25.0, person_brake=0.5, takeover_stage=1.0, refusal=float(Reason.REFUSED_MOVING), commander=2.0,
        ros_throttle=0.25, ecu_brake=0.75, notice=1.0,
    )["/console/arbitration"]  # fmt: skip
    assert (told["mode"], told["mode_words"], told["reason_words"]) == (3, "AUTONOMOUS", "driver asked")
    assert (told["remote_lateral"], told["person_brake"], told["takeover_stage"]) == (1.0, 0.5, 1)
    assert (told["refusal"], told["refusal_words"]) == (29, "refused: car is moving")
    assert (told["notice"], told["notice_words"]) == (1, "throttle is held: autopilot only steers")
    assert (told["commander"], told["commander_words"]) == (2, "CAN")
    ros, ecu = told["ros"], told["ecu"]
    assert (ros["commands_accepted"], ros["commands_refused"], ros["command_age"]) == (7, 2, 0.1)
    assert (ros["state"], ros["state_words"], ros["throttle"], ecu["brake"]) == (0, "no command yet", 0.25, 0.75)


def test_a_failed_recording_is_a_notice(publish: Callable[..., dict[str, Any]]) -> None:
    told = publish(notice=1.0, events=float(Event.RECORDING_FAILED | Event.MARK))["/console/arbitration"]
    assert (told["notice"], told["notice_words"]) == (5, "recording failed: the drive is not kept")


def test_command_that_never_came_has_no_age(publish: Callable[..., dict[str, Any]]) -> None:
    assert publish(age_ticks=NEVER_TICKS)["/console/arbitration"]["ros"]["command_age"] == -1.0


def test_rate_is_met_without_drift_whatever_the_tick() -> None:
    for tick_hz in (50, 100, 125, 250, 1000):
        for rate_hz in (30.0, 50.0, 100.0):
            last: int | None = None
            count = 0
            for tick in range(1, 10 * tick_hz + 1):
                count += is_due(tick, last, tick_hz, rate_hz)
                last = tick
            assert count == 10 * min(rate_hz, tick_hz)


def test_rate_has_its_phase_from_the_tick_alone() -> None:
    assert [tick for tick in range(1, 26) if is_due(tick, tick - 1, 250, 50.0)] == [5, 10, 15, 20, 25]
    assert not is_due(4, None, 250, 50.0)
    assert is_due(7, None, 250, 50.0)  # since the start
    assert not is_due(9, 7, 250, 50.0)
    assert is_due(12, 7, 250, 50.0)
    assert is_due(5, 900, 250, 50.0)


def test_once_and_never() -> None:
    assert is_due(7, None, 250, ONCE)
    assert not is_due(8, 7, 250, ONCE)


@pytest.mark.parametrize(("roll", "pitch", "yaw"), [(0.1, 0.2, 0.3), (0.0, 0.0, 3.0), (-0.3, 0.4, -2.0)])
def test_quaternion_is_the_rotation(roll: float, pitch: float, yaw: float) -> None:
    x, y, z, w = quaternion(roll, pitch, yaw)
    assert x * x + y * y + z * z + w * w == pytest.approx(1.0)
    # Third row and first column of the rotation matrix z-y-x.
    assert 2 * (x * z - w * y) == pytest.approx(-math.sin(pitch))
    assert math.atan2(2 * (y * z + w * x), 1 - 2 * (x * x + y * y)) == pytest.approx(roll)
    assert math.atan2(2 * (x * y + w * z), 1 - 2 * (y * y + z * z)) == pytest.approx(yaw)


def test_with_errors_a_controller_gets_no_ground_truth_unless_it_is_granted(snapshot: Callable[..., Any]) -> None:
    noise = LocalisationProfile(position_noise_m=0.5, yaw_noise_deg=5.0, speed_noise_mps=0.5, yaw_rate_noise_degps=5.0)
    hidden = ConsoleBridge(BridgeProfile(link=LinkProfile(localisation=noise)))
    assert "/ground_truth/odom" not in hidden.router.topics
    shown = Peer(ConsoleBridge(BridgeProfile(link=LinkProfile(localisation=noise, ground_truth=True))))
    for topic in ("/odom", "/ground_truth/odom", "/tf", "/imu/data", VELOCITY):
        shown.send(op="subscribe", topic=topic)
    shown.bridge.publish(snapshot(125), 0)
    shown.heard()
    shown.bridge.publish(snapshot(375, x_m=3.0, yaw_rad=0.5, vx_mps=8.0, yaw_rate_radps=0.2), 0)
    messages = {message["topic"]: message["msg"] for message in shown.heard()}
    truth, odometry = (messages[topic]["pose"] for topic in ("/ground_truth/odom", "/odom"))
    assert truth["pose"]["position"]["x"] == 3.0
    assert truth["pose"]["orientation"]["z"] == pytest.approx(math.sin(0.25))
    assert truth["covariance"] == [0.0] * 36
    assert odometry["pose"]["position"]["x"] != 3.0
    assert odometry["covariance"][0] == pytest.approx(0.25)
    (transform,) = messages["/tf"]["transforms"]
    assert transform["transform"]["translation"]["x"] == odometry["pose"]["position"]["x"]
    assert messages["/imu/data"]["orientation"] == odometry["pose"]["orientation"]
    told, speeds = messages[VELOCITY], messages["/odom"]["twist"]["twist"]
    assert told["longitudinal_velocity"] == pytest.approx(speeds["linear"]["x"], abs=1e-6) != 8.0
    assert told["heading_rate"] == pytest.approx(speeds["angular"]["z"], abs=1e-6) != 0.2
    assert messages["/ground_truth/odom"]["twist"]["twist"]["linear"]["x"] == 8.0
