"""R01 to R13 of the fault catalogue, the link's side: what of a controller's commands reaches the arbiter, and when.

How the arbiter answers to an old, missing or refused command is tests/control's.
"""

import itertools
import json
import math
from collections.abc import Callable
from typing import Any

import cbor2
import pytest

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.console.input_slots import with_age
from simconsole.bridge.protocol.access import Access, Role
from simconsole.bridge.protocol.message_decoding import Binary
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.signals import NEVER_TICKS, Event, RemoteCommand
from tests.samples import Measured, Sample

CONTROL = "/control/command/control_cmd"
MS = 1_000_000
S = 1_000_000_000
TICK_HZ = 100


@pytest.fixture
def held(join: Callable[..., Any], snapshot: Callable[..., Any]) -> Any:
    """A commander whose stamps are held to /clock, at 10 s of it."""
    peer = join(ConsoleBridge(BridgeProfile(sender_clock="console")))
    peer.bridge.publish(snapshot(1000, TICK_HZ), 0)
    return peer


def command(peer: Any) -> RemoteCommand:
    return peer.bridge.inputs.command  # type: ignore[no-any-return]  # peers are fixtures


@pytest.mark.fault("R01")
def test_r01_stale_commands_are_never_applied(held: Any, control: Callable[..., Any], sample: Sample) -> None:
    count = sample.of(30_000, 100_000)
    apart_ns = 9 * S // count
    text = json.dumps({"op": "publish", "topic": CONTROL, "msg": control(stamp_ns=12345678)})
    for number in range(count):
        # From 200 ms and 1 ns old to 10 s old, in microseconds that never repeat.
        stamp_ns = 9 * S + 800 * MS - 1 - apart_ns * number
        held.now_ns += 20 * MS
        held.send(text.replace('"sec": 0', f'"sec": {stamp_ns // S}').replace("12345678", str(stamp_ns % S)))
    assert (command(held).sequence, command(held).refused) == (0.0, count)


@pytest.mark.fault("R02")
def test_r02_age_of_a_commander_that_stops_is_told_tick_by_tick(peer: Any, control: Callable[..., Any]) -> None:
    inputs = peer.bridge.inputs
    assert inputs.take(1)[0].age_ticks == NEVER_TICKS
    inputs.tick = 10
    peer.publish(CONTROL, control(0.1))
    assert [inputs.take(tick)[0].age_ticks for tick in (11, 12, 31, 60)] == [0.0, 1.0, 20.0, 49.0]
    # The same by a clock, for a core whose bridge is another process.
    ages = [with_age(command(peer), 0, ms * MS, TICK_HZ).age_ticks for ms in (0, 9, 10, 199, 210)]
    assert ages == [0.0, 0.0, 1.0, 19.0, 21.0]


@pytest.mark.fault("R02")
def test_r02_refused_commands_are_no_sign_of_life(peer: Any, control: Callable[..., Any]) -> None:
    inputs = peer.bridge.inputs
    peer.publish(CONTROL, control(0.1))
    inputs.tick = 50
    peer.publish(CONTROL, control(99.0))
    assert inputs.take(51)[0].age_ticks == 50.0


@pytest.mark.fault("R03")
def test_r03_late_but_steady_commands_are_taken(
    held: Any, control: Callable[..., Any], snapshot: Callable[..., Any]
) -> None:
    for tick in range(1001, 2001):
        held.bridge.publish(snapshot(tick, TICK_HZ), 0)
        held.now_ns += 10 * MS
        stamp_ns = tick * 10 * MS - 150 * MS
        assert held.publish(CONTROL, control(0.1, stamp_ns=stamp_ns)).kind == "command"
    assert command(held).refused == 0.0


@pytest.mark.fault("R04")
@pytest.mark.parametrize("stamps_ms", [(0, -1), (0, 0), (0, 1, 0), (51,), (10_000,), (-201,), (0, -100, -1)])
def test_r04_order_and_future(held: Any, control: Callable[..., Any], stamps_ms: tuple[int, ...]) -> None:
    kinds = [held.publish(CONTROL, control(stamp_ns=10 * S + at * MS)).kind for at in stamps_ms]
    assert kinds[-1] == "refused"
    assert command(held).refused == kinds.count("refused")
    assert held.publish(CONTROL, control(0.3, stamp_ns=10 * S + 40 * MS)).kind == "command"


COMMANDS: dict[str, dict[str, Any]] = {
    CONTROL: {
        "stamp": {"sec": 1, "nanosec": 5},
        "lateral": {"steering_tire_angle": 0.1, "steering_tire_rotation_rate": 0.2},
        "longitudinal": {"velocity": 1.0, "acceleration": 1.0, "jerk": 0.5},
    },
    "/ackermann_cmd": {
        "header": {"frame_id": "base_link"},
        "drive": {
            "steering_angle": 0.1, "steering_angle_velocity": 0.1, "speed": 1.0, "acceleration": 1.0, "jerk": 0.1,
        },
    },
    "/control/command/actuation_cmd": {
        "header": {"frame_id": "base_link"},
        "actuation": {"accel_cmd": 0.5, "brake_cmd": 0.5, "steer_cmd": 0.1},
    },
    "/cmd_vel": {"linear": {"x": 1.0, "y": 0.0, "z": 0.0}, "angular": {"x": 0.0, "y": 0.0, "z": 0.1}},
    "/cmd_vel_stamped": {
        "header": {"frame_id": "base_link"},
        "twist": {"linear": {"x": 1.0, "y": 0.0, "z": 0.0}, "angular": {"x": 0.0, "y": 0.0, "z": 0.1}},
    },
    "/ball/desired_pose": {
        "header": {"frame_id": "map"},
        "pose": {"position": {"x": 1.0, "y": 1.0, "z": 0.0}, "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}},
    },
    "/ball/desired_speed": {"data": 1.0},
}  # fmt: skip


def numbers(message: Any, path: tuple[str, ...] = ()) -> list[tuple[str, ...]]:
    """The paths of all fields that are numbers with a point."""
    if isinstance(message, dict):
        return [found for key, part in message.items() for found in numbers(part, (*path, key))]
    return [path] if isinstance(message, float) else []


def with_number(message: dict[str, Any], path: tuple[str, ...], value: Any) -> dict[str, Any]:
    copy: dict[str, Any] = json.loads(json.dumps(message))
    *parents, last = path
    holder = copy
    for key in parents:
        holder = holder[key]
    holder[last] = value
    return copy


FIELDS = [(topic, path) for topic, message in COMMANDS.items() for path in numbers(message)]


@pytest.mark.fault("R05")
@pytest.mark.parametrize(("topic", "path"), FIELDS, ids=lambda part: part if isinstance(part, str) else ".".join(part))
def test_r05_numbers_at_the_edge_in_every_field(peer: Any, topic: str, path: tuple[str, ...]) -> None:
    assert peer.publish(topic, COMMANDS[topic]).kind == "command"
    taken = command(peer)
    never = (math.nan, math.inf, -math.inf)
    for value in never:
        wrong = with_number(COMMANDS[topic], path, value)
        assert peer.publish(topic, wrong).kind == "refused"
        assert peer.send(Binary(cbor2.dumps({"op": "publish", "topic": topic, "msg": wrong}))).kind == "refused"
    for text in ("1e999", "-1e999", "1e400", "null", '"NaN"', '"1.0"', "true", "[]", "{}", "1" * 400, "NaN1", "+1"):
        message = json.dumps(with_number(COMMANDS[topic], path, 12321)).replace("12321", text)
        assert peer.send(f'{{"op":"publish","topic":"{topic}","msg":{message}}}').kind == "refused", text
    assert command(peer)._replace(refused=0.0) == taken
    for value in (-0.0, 1e308, -1e308, 5e-324, 2.2e-308, 2**53, 2**63, 1):
        peer.publish(topic, with_number(COMMANDS[topic], path, value))
        assert all(map(math.isfinite, command(peer)))
        assert max(map(abs, command(peer)[4:])) <= 1e5  # the widest limit of them all, the ball's


@pytest.mark.fault("R06")
@pytest.mark.fault("R08")
@pytest.mark.parametrize("value", [1.21, -1.21, 7.0, 57.3, 1e6])
def test_r06_r08_step_or_unit_beyond_the_limit_is_refused_and_counted(
    peer: Any, control: Callable[..., Any], value: float
) -> None:
    for number in range(5):
        outcome = peer.publish(CONTROL, control(road_wheel_rad=value))
        assert "is not within -1.2 to 1.2 - at `$.lateral.steering_tire_angle`" in outcome.text
        assert (command(peer).sequence, command(peer).refused) == (0.0, number + 1.0)
    assert peer.publish(CONTROL, control(road_wheel_rad=1.2)).kind == "command"


@pytest.mark.fault("R07")
@pytest.mark.parametrize(
    ("operation", "complaint"),
    [
        ({"op": "advertise", "topic": CONTROL, "type": "std_msgs/String"}, "the topic is autoware_control_msgs"),
        ({"op": "advertise", "topic": CONTROL, "type": "nobody_msgs/Control"}, "not known here"),
        ({"op": "publish", "topic": CONTROL, "msg": []}, "msg must be an object"),
        ({"op": "publish", "topic": CONTROL, "msg": "x"}, "msg must be an object"),
        ({"op": "publish", "topic": CONTROL, "msg": {**COMMANDS[CONTROL], "extra": 1}}, "unknown field `extra`"),
        (
            {"op": "publish", "topic": CONTROL, "msg": {**COMMANDS[CONTROL], "lateral": {"steering": 1}}},
            "`$.lateral`",
        ),
        ({"op": "publish", "topic": CONTROL, "msg": {**COMMANDS[CONTROL], "lateral": 5}}, "`$.lateral`"),
        ({"op": "publish", "topic": CONTROL, "msg": {**COMMANDS[CONTROL], "stamp": 5}}, "`$.stamp`"),
        ({"op": "publish", "topic": CONTROL, "msg": {"lateral": COMMANDS[CONTROL]["lateral"]}}, "longitudinal"),
        ({"op": "publish", "topic": CONTROL, "msg": {}}, "required in a command"),
    ],
)
def test_r07_wrong_type_or_fields_have_a_status_and_the_connection_stays(
    peer: Any, operation: dict[str, Any], complaint: str
) -> None:
    assert peer.send(**operation, id="mine").kind == "refused"
    (status,) = peer.heard()
    assert (status["op"], status["level"], status["id"]) == ("status", "error", "mine")
    assert complaint in status["msg"]
    assert command(peer).sequence == 0.0
    assert peer.publish(CONTROL, COMMANDS[CONTROL]).kind == "command"


@pytest.mark.fault("R08")
@pytest.mark.parametrize(
    ("topic", "good", "bad"),
    [
        ("/ackermann_cmd", ["", "base_link", "/base_link"], ["map", "odom", "base_footprint", "x" * 1000]),
        ("/cmd_vel_stamped", ["", "base_link", "/base_link"], ["map", "odom", "BASE_LINK"]),
        ("/ball/desired_pose", ["", "map", "/map", "odom"], ["base_link", "earth"]),
    ],
)
def test_r08_command_in_another_frame_is_refused(peer: Any, topic: str, good: list[str], bad: list[str]) -> None:
    for frame in good:
        assert peer.publish(topic, {**COMMANDS[topic], "header": {"frame_id": frame}}).kind == "command"
    before = command(peer)
    for frame in bad:
        outcome = peer.publish(topic, {**COMMANDS[topic], "header": {"frame_id": frame}})
        assert "at `$.header.frame_id`" in outcome.text
    assert command(peer)._replace(refused=0.0) == before


@pytest.mark.fault("R09")
def test_r09_flood_of_ten_thousand_a_second_for_a_minute(
    peer: Any, control: Callable[..., Any], sample: Sample, measured: Measured
) -> None:
    """Simulated time, so that what is tested is which command a tick gets; test_r_flood.py has it over a socket."""
    seconds = sample.of(15, 60)
    text = json.dumps({"op": "publish", "topic": CONTROL, "msg": control(0.1)}).encode()
    receipts: list[int | None] = []
    statuses = sent = 0
    peer.send(op="set_level", level="error")
    for tick in range(seconds * TICK_HZ):
        for _ in range(100):
            peer.now_ns += 100_000
            sent += 1
            peer.send(text)
        statuses += len(peer.heard())
        receipts.append(peer.bridge.inputs.receipt_ns)
        peer.bridge.inputs.take(tick)
    ages_ms = sorted((tick + 1) * 10 - receipt / MS for tick, receipt in enumerate(receipts) if receipt is not None)
    assert len(ages_ms) == len(receipts)
    p99_ms = ages_ms[int(0.99 * len(ages_ms))]
    seen = f"p99 {p99_ms:.1f} ms, max {ages_ms[-1]:.1f} ms of simulated time"
    measured("R09", "age of the applied command at 10 kHz", seen, "20 ms and 50 ms")
    assert p99_ms <= 20.0
    assert ages_ms[-1] <= 50.0
    passed_over = peer.session.throttled
    assert sent == seconds * 10_000
    assert command(peer).sequence == sent - passed_over
    assert seconds * 500 <= command(peer).sequence <= (seconds + 1) * 500
    assert command(peer).refused == 0.0
    assert 0.9 * seconds <= statuses <= seconds + 1
    assert peer.session.send_queue.bytes == 0


@pytest.mark.fault("R09")
def test_r09_the_flooded_commander_is_told_what_is_done(peer: Any, control: Callable[..., Any]) -> None:
    for _ in range(600):
        outcome = peer.publish(CONTROL, control())
    assert outcome.kind == "throttled"
    (status,) = peer.heard()
    assert status["level"] == "error"
    assert "more than 500 commands a second" in status["msg"]
    # Emergency stops are never passed over.
    assert peer.publish("/console/request", {"data": "estop"}).kind == "command"


@pytest.mark.fault("R10")
def test_r10_one_commander_at_a_time(
    bridge: ConsoleBridge, join: Callable[..., Any], control: Callable[..., Any]
) -> None:
    first, second = join(bridge), join(bridge)
    assert first.publish(CONTROL, control(0.1)).kind == "command"
    second.now_ns = 499 * MS
    assert "another client commands" in second.publish(CONTROL, control(0.2)).text
    assert bridge.inputs.command.road_wheel_rad == 0.1
    assert bridge.inputs.command.refused == 0.0  # a stranger's commands are not the commander's mistakes
    second.now_ns = 500 * MS
    assert second.publish(CONTROL, control(0.2)).kind == "command"
    first.now_ns = 600 * MS
    assert first.publish(CONTROL, control(0.3)).kind == "refused"
    bridge.disconnect(second.session, 600 * MS)
    assert first.publish(CONTROL, control(0.3)).kind == "command"


@pytest.mark.fault("R11")
@pytest.mark.parametrize("role", [Role.NONE, Role.VIEW, Role.PUBLISH])
@pytest.mark.parametrize("topic", [*COMMANDS, "/console/request", "/control/command/gear_cmd"])
def test_r11_unauthenticated_client_commands_nothing(
    bridge: ConsoleBridge, join: Callable[..., Any], role: Role, topic: str
) -> None:
    bridge.router.access = Access({"t" * 16: Role.CONTROL}, role)
    peer = join(bridge)
    before = bridge.inputs.command
    message = COMMANDS.get(topic) or ({"data": "estop"} if "request" in topic else {"command": 2})
    assert "this needs the role" in peer.publish(topic, message).text
    assert bridge.inputs.command == before
    assert bridge.inputs.take(1)[1].events == 0.0
    assert peer.session.refused == 1
    peer.send(op="auth", token="t" * 16)
    assert peer.publish(topic, message).kind == "command"


@pytest.mark.fault("R12")
def test_r12_requests_are_handed_on_once_each_whoever_commands(
    bridge: ConsoleBridge, join: Callable[..., Any], control: Callable[..., Any]
) -> None:
    commander, other = join(bridge), join(bridge)
    commander.publish(CONTROL, control())
    for word, event in (("autonomous", Event.REQUEST_AUTONOMOUS), ("estop", Event.EMERGENCY_STOP)):
        assert other.publish("/console/request", {"data": word}).kind == "command"
        assert [bridge.inputs.take(tick)[1].events for tick in (1, 2)] == [event, 0.0]
    assert "not one of" in other.publish("/console/request", {"data": "AUTONOMOUS"}).text
    assert bridge.inputs.take(3)[1].events == 0.0


@pytest.mark.fault("R13")
def test_r13_toggling_loses_no_edge(peer: Any) -> None:
    seen = []
    for tick, word in zip(range(500), itertools.cycle(["autonomous", "manual"]), strict=False):
        peer.now_ns += 20 * MS
        peer.publish("/console/request", {"data": word})
        if tick % 3 == 2:  # the core is slower than the toggling
            seen.append(int(peer.bridge.inputs.take(tick)[1].events))
    assert set(seen) == {int(Event.REQUEST_AUTONOMOUS | Event.REQUEST_MANUAL)}
