import math
from collections.abc import Callable
from typing import Any

import pytest

from simconsole.bridge.console.command_decoder import CommandDecoder
from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.protocol.operations import write_publish
from simconsole.profiles.bridge import BridgeProfile, CommandLimits
from simconsole.values.errors import RemoteProtocolError
from simconsole.values.signals import Event, RemoteCommand, RemoteKind

CONTROL = "/control/command/control_cmd"


def command(peer: Any) -> RemoteCommand:
    return peer.bridge.inputs.command  # type: ignore[no-any-return]  # peers are fixtures


def test_autoware_control_is_an_acceleration(peer: Any) -> None:
    msg = {
        "stamp": {"sec": 1, "nanosec": 5},
        "lateral": {"steering_tire_angle": 0.25, "steering_tire_rotation_rate": -0.5},
        "longitudinal": {"velocity": 8.0, "acceleration": -1.5, "jerk": 2.0, "is_defined_acceleration": True},
    }
    assert peer.publish(CONTROL, msg).kind == "command"
    got = command(peer)
    assert got.kind == RemoteKind.ACCELERATION
    assert (got.road_wheel_rad, got.road_wheel_radps, got.speed_mps, got.accel_mps2) == (0.25, -0.5, 8.0, -1.5)
    assert (got.sequence, got.direction, peer.bridge.inputs.stamp_ns) == (1.0, 1.0, 1_000_000_005)


def test_ackermann_is_a_speed_and_its_sign_a_direction(peer: Any) -> None:
    drive = {"steering_angle": -0.1, "steering_angle_velocity": 0.2, "speed": -2.0, "acceleration": 1.0}
    assert peer.publish("/ackermann_cmd", {"drive": drive}).kind == "command"
    got = command(peer)
    assert got.kind == RemoteKind.SPEED
    assert (got.road_wheel_rad, got.road_wheel_radps, got.speed_mps, got.accel_mps2) == (-0.1, 0.2, -2.0, 1.0)
    assert got.direction == -1.0
    peer.publish("/ackermann_cmd", {"drive": {**drive, "speed": 0}})
    assert command(peer).direction == -1.0


def test_actuation_is_pedals_and_the_road_wheel(peer: Any) -> None:
    topic = "/control/command/actuation_cmd"
    asked = {"accel_cmd": 0.25, "brake_cmd": 0.0, "steer_cmd": -0.5}
    stamped = {"header": {"stamp": {"sec": 3}, "frame_id": "base_link"}, "actuation": asked}
    assert peer.publish("/control/command/gear_cmd", {"command": 20}).kind == "command"
    assert peer.publish(topic, stamped).kind == "command"
    got = command(peer)
    assert (got.kind, got.throttle, got.brake, got.road_wheel_rad) == (RemoteKind.ACTUATION, 0.25, 0.0, -0.5)
    assert (got.sequence, got.direction, peer.bridge.inputs.stamp_ns) == (1.0, -1.0, 3_000_000_000)
    for name, value, text in (
        ("accel_cmd", 1.01, "1.01 is not within 0 to 1"),
        ("accel_cmd", -0.01, "-0.01 is not within 0 to 1"),
        ("brake_cmd", -0.5, "-0.5 is not within 0 to 1"),
        ("steer_cmd", 1.3, "1.3 is not within -1.2 to 1.2"),
    ):
        outcome = peer.publish(topic, {"actuation": {**asked, name: value}})
        assert f"{text} - at `$.actuation.{name}`" in outcome.text
    assert "is not base_link" in peer.publish(topic, {**stamped, "header": {"frame_id": "map"}}).text
    assert command(peer) == got._replace(refused=5.0)


def test_a_command_given_in_full_is_read_at_once_and_means_the_same(peer: Any) -> None:
    registry = peer.bridge.router.registry
    twist, vector = (registry.struct(f"geometry_msgs/{name}") for name in ("Twist", "Vector3"))
    whole = twist(linear=vector(x=3.0), angular=vector(z=0.4))
    assert peer.send(write_publish("/cmd_vel", whole)).kind == "command"
    at_once = command(peer)
    plain = {"linear": {"x": 3.0, "y": 0.0, "z": 0.0}, "angular": {"x": 0.0, "y": 0.0, "z": 0.4}}
    assert peer.publish("/cmd_vel", plain).kind == "command"
    assert command(peer) == at_once._replace(sequence=2.0)
    assert (at_once.kind, at_once.speed_mps, at_once.yaw_rate_radps) == (RemoteKind.TWIST, 3.0, 0.4)
    fast = twist(linear=vector(x=1e6), angular=vector())
    refused = peer.send(write_publish("/cmd_vel", fast))
    assert refused.text == peer.publish("/cmd_vel", {**plain, "linear": {"x": 1e6, "y": 0.0, "z": 0.0}}).text != ""
    assert command(peer).refused == 2.0


def test_twist_and_its_stamped_form(peer: Any) -> None:
    twist = {"linear": {"x": 3.0, "y": 0.0, "z": 0.0}, "angular": {"x": 0.0, "y": 0.0, "z": 0.4}}
    assert peer.publish("/cmd_vel", twist).kind == "command"
    got = command(peer)
    assert (got.kind, got.speed_mps, got.yaw_rate_radps) == (RemoteKind.TWIST, 3.0, 0.4)
    assert peer.bridge.inputs.stamp_ns is None
    assert peer.publish("/cmd_vel_stamped", {"header": {"stamp": {"sec": 2}}, "twist": twist}).kind == "command"
    assert peer.bridge.inputs.stamp_ns == 2_000_000_000


def test_ball_takes_pose_and_speed(peer: Any) -> None:
    half = math.sqrt(0.5)
    pose = {"position": {"x": 1.0, "y": -2.0}, "orientation": {"z": half, "w": half}}
    assert peer.publish("/ball/desired_speed", {"data": 1.5}).kind == "command"
    assert command(peer).sequence == 0.0
    assert peer.publish("/ball/desired_pose", {"pose": pose}).kind == "command"
    got = command(peer)
    assert (got.kind, got.x_m, got.y_m, got.speed_mps, got.sequence) == (RemoteKind.POSE, 1.0, -2.0, 1.5, 1.0)
    assert got.yaw_rad == pytest.approx(math.pi / 2)
    peer.publish("/ball/desired_speed", {"data": 0.5})
    assert (command(peer).speed_mps, command(peer).x_m, command(peer).sequence) == (0.5, 1.0, 2.0)
    bad = {"pose": {**pose, "orientation": {"w": 0.0}}}
    assert "unit quaternion" in peer.publish("/ball/desired_pose", bad).text


@pytest.mark.parametrize(
    ("gear", "direction"), [(1, 0.0), (2, 1.0), (19, 1.0), (20, -1.0), (21, -1.0), (22, 0.0), (24, 1)]
)
def test_gear_sets_the_direction_and_is_no_sign_of_life(peer: Any, gear: int, direction: float) -> None:
    assert peer.publish("/control/command/gear_cmd", {"command": gear}).kind == "command"
    assert (command(peer).direction, command(peer).sequence) == (direction, 0.0)


def test_no_gear_is_refused(peer: Any) -> None:
    for gear in (0, 25, 255):
        assert "is no gear" in peer.publish("/control/command/gear_cmd", {"command": gear}).text


@pytest.mark.parametrize(
    ("topic", "number", "field", "value"),
    [
        ("turn_indicators_cmd", 2, "turn_indicators", 1.0),
        ("turn_indicators_cmd", 3, "turn_indicators", -1.0),
        ("hazard_lights_cmd", 2, "hazard_lights", 1.0),
    ],
)
def test_lights_are_kept_and_are_no_sign_of_life(peer: Any, topic: str, number: int, field: str, value: float) -> None:
    topic = f"/control/command/{topic}"
    assert peer.publish(topic, {"command": number}).kind == "command"
    assert (getattr(command(peer), field), command(peer).sequence) == (value, 0.0)
    peer.publish("/cmd_vel", {"linear": {"x": 3.0}, "angular": {"z": 0.0}})
    assert (getattr(command(peer), field), command(peer).sequence) == (value, 1.0)
    assert peer.publish(topic, {"command": 0}).kind == "command"  # NO_COMMAND
    assert getattr(command(peer), field) == value
    assert peer.publish(topic, {"command": 1}).kind == "command"  # DISABLE
    assert getattr(command(peer), field) == 0.0


def test_lights_that_there_are_not_are_refused(peer: Any) -> None:
    for topic, number, text in (
        ("turn_indicators_cmd", 4, "4 is not a turn"),
        ("hazard_lights_cmd", 3, "3 is not a state"),
    ):
        assert text in peer.publish(f"/control/command/{topic}", {"command": number}).text
    old = {"stamp": {"sec": 5}, "command": 2}
    assert peer.publish("/control/command/hazard_lights_cmd", old).kind == "command"
    assert "not newer" in peer.publish("/control/command/hazard_lights_cmd", old).text


@pytest.mark.parametrize(
    ("word", "event"),
    [
        ("autonomous", Event.REQUEST_AUTONOMOUS),
        ("manual", Event.REQUEST_MANUAL),
        ("takeover", Event.REQUEST_TAKEOVER),
        ("estop", Event.EMERGENCY_STOP),
        ("reset", Event.RESET),
    ],
)
def test_requests_are_events(peer: Any, word: str, event: Event) -> None:
    assert peer.publish("/console/request", {"data": word}).kind == "command"
    assert peer.bridge.inputs.take(1)[1].events == event


def test_unknown_request_is_refused(peer: Any) -> None:
    assert "not one of autonomous, manual" in peer.publish("/console/request", {"data": "ESTOP"}).text


@pytest.mark.parametrize(
    ("topic", "msg", "path"),
    [
        (CONTROL, {}, "$.lateral.steering_tire_angle"),
        (CONTROL, {"lateral": {"steering_tire_angle": 0.1}}, "$.longitudinal.acceleration"),
        (CONTROL, {"lateral": {}, "longitudinal": {"acceleration": 1}}, "$.lateral.steering_tire_angle"),
        ("/ackermann_cmd", {"drive": {"speed": 1.0}}, "$.drive.steering_angle"),
        (
            "/control/command/actuation_cmd",
            {"actuation": {"brake_cmd": 0.0}},
            "$.actuation.accel_cmd",
        ),
        ("/cmd_vel", {"linear": {"x": 1.0}}, "$.angular.z"),
        ("/cmd_vel_stamped", {"twist": {"angular": {"z": 1.0}}}, "$.twist.linear.x"),
        ("/ball/desired_pose", {"pose": {"position": {"x": 1.0}}}, "$.pose.position.y"),
        ("/ball/desired_speed", {}, "$.data"),
        ("/control/command/gear_cmd", {}, "$.command"),
        ("/control/command/turn_indicators_cmd", {}, "$.command"),
        ("/control/command/hazard_lights_cmd", {}, "$.command"),
    ],
)
def test_command_is_never_zero_by_omission(peer: Any, topic: str, msg: dict[str, Any], path: str) -> None:
    outcome = peer.publish(topic, msg)
    assert outcome.kind == "refused"
    assert f"required in a command - at `{path}`" in outcome.text
    assert command(peer) == command(peer)._replace(sequence=0.0, refused=1.0)


@pytest.mark.parametrize(
    ("topic", "msg", "path"),
    [
        (
            CONTROL,
            {"lateral": {"steering_tire_angle": 1.21}, "longitudinal": {"acceleration": 0}},
            "steering_tire_angle",
        ),
        (
            CONTROL,
            {"lateral": {"steering_tire_angle": 57.0}, "longitudinal": {"acceleration": 0}},
            "steering_tire_angle",
        ),
        (CONTROL, {"lateral": {"steering_tire_angle": 0}, "longitudinal": {"acceleration": -12.1}}, "acceleration"),
        (
            CONTROL,
            {
                "lateral": {"steering_tire_angle": 0, "steering_tire_rotation_rate": 21},
                "longitudinal": {"acceleration": 0},
            },
            "steering_tire_rotation_rate",
        ),
        ("/ackermann_cmd", {"drive": {"steering_angle": 0, "speed": 1e308}}, "drive.speed"),
        ("/cmd_vel", {"linear": {"x": 0}, "angular": {"z": -10.5}}, "angular.z"),
        ("/ball/desired_pose", {"pose": {"position": {"x": 0, "y": 1e6}}}, "pose.position.y"),
        ("/ball/desired_speed", {"data": 81}, "data"),
    ],
)
def test_value_beyond_its_limit_refuses_the_whole_command(
    peer: Any, topic: str, msg: dict[str, Any], path: str
) -> None:
    outcome = peer.publish(topic, msg)
    assert outcome.kind == "refused"
    assert "is not within" in outcome.text
    assert path in outcome.text
    assert (command(peer).sequence, command(peer).refused) == (0.0, 1.0)


def test_limits_come_from_the_profile(join: Callable[..., Any], control: Callable[..., Any]) -> None:
    peer = join(ConsoleBridge(BridgeProfile(commands=CommandLimits(accel_mps2=2.0))))
    assert peer.publish(CONTROL, control(accel_mps2=2.0)).kind == "command"
    assert peer.publish(CONTROL, control(accel_mps2=2.1)).kind == "refused"


def test_stamps_must_grow(peer: Any, control: Callable[..., Any]) -> None:
    kinds = [peer.publish(CONTROL, control(stamp_ns=stamp)).kind for stamp in (20, 10, 20, 21, 0, 21, 22)]
    assert kinds == ["command", "refused", "refused", "command", "command", "refused", "command"]
    assert "not newer" in peer.publish(CONTROL, control(stamp_ns=22)).text


def test_stamp_of_a_refused_command_does_not_count(peer: Any, control: Callable[..., Any]) -> None:
    peer.publish(CONTROL, control(road_wheel_rad=2.0, stamp_ns=100))
    assert peer.publish(CONTROL, control(stamp_ns=50)).kind == "command"


def test_next_commander_may_have_an_earlier_clock(
    bridge: ConsoleBridge, join: Callable[..., Any], control: Callable[..., Any]
) -> None:
    first, second = join(bridge), join(bridge)
    first.publish(CONTROL, control(stamp_ns=10**12))
    second.now_ns = 10**9
    assert second.publish(CONTROL, control(stamp_ns=10**9)).kind == "command"


def test_own_clock_of_the_sender_is_not_compared_with_ours(peer: Any, control: Callable[..., Any]) -> None:
    assert peer.publish(CONTROL, control(stamp_ns=1_700_000_000 * 10**9)).kind == "command"


def test_sender_on_our_clock_is_held_to_it(
    join: Callable[..., Any], control: Callable[..., Any], snapshot: Callable[..., Any]
) -> None:
    bridge = ConsoleBridge(BridgeProfile(sender_clock="console"))
    peer = join(bridge)
    bridge.publish(snapshot(250), 0)  # 1 s
    second = 10**9
    assert "from the future" in peer.publish(CONTROL, control(stamp_ns=second + 50_000_001)).text
    assert "older than 200 ms" in peer.publish(CONTROL, control(stamp_ns=second - 200_000_001)).text
    assert peer.publish(CONTROL, control(stamp_ns=second - 200_000_000)).kind == "command"
    assert peer.publish(CONTROL, control(stamp_ns=second + 50_000_000)).kind == "command"


def test_both_spellings_of_a_stamp(peer: Any, control: Callable[..., Any]) -> None:
    assert peer.publish(CONTROL, {**control(), "stamp": {"secs": 1, "nsecs": 2}}).kind == "command"
    assert peer.bridge.inputs.stamp_ns == 1_000_000_002


def test_value_that_is_not_finite_is_refused_whoever_brings_it(bridge: ConsoleBridge) -> None:
    """JSON cannot say it; a later encoding of the same messages could."""
    decoder = CommandDecoder(bridge.inputs, BridgeProfile())
    (topic,) = (topic for topic in decoder.topics() if topic.name == "/ball/desired_speed")
    for value in (math.nan, math.inf, -math.inf):
        with pytest.raises(RemoteProtocolError, match="not finite"):
            topic.accept({"data": value}, bridge.router.registry.struct(topic.type)(value), 0)


@pytest.mark.parametrize("frame", ["base_link", "/base_link", ""])
def test_command_in_the_car_s_own_frame(peer: Any, frame: str) -> None:
    message = {"header": {"frame_id": frame}, "drive": {"steering_angle": 0.1, "speed": 1.0}}
    assert peer.publish("/ackermann_cmd", message).kind == "command"
    message["header"] = {"frame_id": f"{frame}_elsewhere"}
    assert "is not base_link - at `$.header.frame_id`" in peer.publish("/ackermann_cmd", message).text
