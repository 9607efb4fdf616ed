"""N07 by volume: inputs, most of them valid messages with one field mutated; nothing uncaught or not finite.

Only the transport-free core; what it would send is read back by a strict reader.
"""

import json
import math
import random
from collections.abc import Iterator
from time import process_time
from typing import Any

import cbor2
import orjson
import pytest

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.protocol.access import Access, Role
from simconsole.bridge.protocol.message_decoding import Binary
from simconsole.profiles.bridge import BridgeProfile
from tests.faults.wrecks import wreck
from tests.samples import Measured, Sample

EACH = 20_000
"""Inputs for one console; then everything begins anew, so that its tables are not full all the time."""
SLOW_S, LONGEST_S = 0.001, 0.010
"""Of the processor's time: what hardly any input may cost, and none."""

HEADER = {"stamp": {"sec": 1, "nanosec": 2}, "frame_id": ""}
VECTOR = {"x": 1.0, "y": 0.5, "z": 0.0}
POSE = {"position": VECTOR, "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}}
LATERAL = {"steering_tire_angle": 0.1, "steering_tire_rotation_rate": 0.0}
LONGITUDINAL = {"velocity": 1.0, "acceleration": 0.5, "jerk": 0.0}
ODOMETRY = {
    "header": HEADER,
    "child_frame_id": "b",
    "pose": {"pose": POSE, "covariance": [0.0] * 36},
    "twist": {"twist": {"linear": VECTOR, "angular": VECTOR}, "covariance": [0.0] * 36},
}


def publish(topic: str, msg: Any) -> dict[str, Any]:
    return {"op": "publish", "topic": topic, "msg": msg, "id": "i"}


CONTROL = publish("/control/command/control_cmd", {"lateral": LATERAL, "longitudinal": LONGITUDINAL})
VALID: list[dict[str, Any]] = [
    *[CONTROL] * 6,
    publish("/control/command/gear_cmd", {"command": 2}),
    publish("/control/command/actuation_cmd", {"actuation": {"accel_cmd": 0.5, "brake_cmd": 0.0, "steer_cmd": 0.1}}),
    publish("/ackermann_cmd", {"header": HEADER, "drive": {"steering_angle": 0.1, "speed": 1.0}}),
    publish("/cmd_vel", {"linear": VECTOR, "angular": VECTOR}),
    publish("/ball/desired_pose", {"header": HEADER, "pose": POSE}),
    publish("/ball/desired_speed", {"data": 1.0}),
    publish("/console/request", {"data": "mark"}),
    *[publish("/relayed", ODOMETRY)] * 4,
    publish("/octets", {"data": [1, 2, 3]}),
    publish("/scan", {"header": HEADER, "angle_min": 0.0, "ranges": [1.0, 2.0], "intensities": []}),
    {"op": "advertise", "topic": "/own", "type": "std_msgs/String", "id": "a", "latch": True, "qos": {"depth": 3}},
    {"op": "unadvertise", "topic": "/own", "id": "a"},
    {
        "op": "subscribe", "topic": "/relayed", "type": "nav_msgs/Odometry", "id": "s", "throttle_rate": 0,
        "queue_length": 2, "fragment_size": 100, "compression": "none", "qos": {"durability": "volatile"},
    },
    {"op": "unsubscribe", "topic": "/relayed", "id": "s"},
    {"op": "call_service", "service": "/rosapi/topics", "id": "c", "args": {}, "timeout": 1.0, "compression": "none"},
    {"op": "call_service", "service": "/rosapi/message_details", "id": "c", "args": {"type": "nav_msgs/Odometry"}},
    {"op": "call_service", "service": "/rosapi/set_param", "id": "c", "args": {"name": "n", "value": "1"}},
    {"op": "advertise_service", "service": "/add", "type": "example_interfaces/AddTwoInts"},
    {"op": "service_response", "service": "/add", "id": "call:/add:1", "values": {"sum": 1}, "result": True},
    {"op": "advertise_action", "action": "/count", "type": "example_interfaces/Fibonacci"},
    {"op": "send_action_goal", "action": "/count", "args": {"order": 1}, "id": "g", "feedback": True},
    {"op": "cancel_action_goal", "action": "/count", "id": "g"},
    {"op": "action_feedback", "action": "/count", "id": "goal:/count:1", "values": {"sequence": [1]}},
    {"op": "action_result", "action": "/count", "id": "goal:/count:1", "values": {"sequence": [1]}, "status": 4},
    {"op": "fragment", "id": "f", "num": 0, "total": 2, "data": '{"op":'},
    {"op": "status", "level": "error", "msg": "m", "id": "x"},
    {"op": "set_level", "level": "error"},
    {"op": "auth", "mac": "", "client": "c", "dest": "d", "rand": "r", "t": 1, "level": "l", "end": 2},
]  # fmt: skip
ATOMS: list[Any] = [
    None, True, False, -1, 0, 1, 255, 256, -0.0, 1.5, 1e308, -1e308, 5e-324, 2**31, 2**53 + 1, 2**63, 2**64,
    -(2**63) - 1, 10**400, "", "x", "NaN", "1", "/", "/clock", "~", "é€𝄞", "\u0000", "x" * 300, "none", "cbor", "png",
    [], {}, [[]], [{}], [None], {"x": 1}, {"sec": -1}, {"secs": 1, "nsecs": 5}, [0.0] * 36, [None] * 36, "AQL/",
]  # fmt: skip
WORDS = [json.dumps(atom) for atom in ATOMS] + [
    "NaN",
    "-Infinity",
    "Infinity",
    "1e999",
    "-1e999",
    "01",
    "+1",
    "nul",
    "",
]


def cuts(value: Any) -> Iterator[tuple[str, str]]:
    """What stands before and after each field's value in the text of a message."""
    mark = "\u0001mark\u0001"
    for path in paths(value):
        copy = json.loads(json.dumps(value))
        *parents, last = path
        holder = copy
        for key in parents:
            holder = holder[key]
        holder[last] = mark
        before, _, after = json.dumps(copy).partition(json.dumps(mark))
        yield before, after


def paths(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    if path:
        yield path
    if isinstance(value, dict):
        for key, part in value.items():
            yield from paths(part, (*path, key))
    elif isinstance(value, list) and value:
        yield from paths(value[0], (*path, 0))


CUTS = [list(cuts(message)) for message in VALID]
TEXTS = [json.dumps(message).encode() for message in VALID]
PLAIN = [atom for atom in ATOMS if atom != 10**400] + [math.nan, math.inf, -math.inf, b"octets", cbor2.undefined]


def mutated(chance: random.Random) -> bytes:
    """A valid message with one field replaced."""
    before, after = chance.choice(chance.choice(CUTS))
    return f"{before}{chance.choice(WORDS)}{after}".encode("utf-8", "surrogatepass")


def wrecked(chance: random.Random) -> bytes:
    """The text of a valid message with a few bytes cut, put in or turned over."""
    return wreck(chance, chance.choice(TEXTS), 3)


def packed(chance: random.Random) -> bytes:
    """A message in CBOR with one field replaced, or that with bytes turned over."""
    message = dict(chance.choice(VALID))
    message[chance.choice(list(message))] = chance.choice(PLAIN)
    data = bytearray(cbor2.dumps(message))
    if chance.random() < 0.5:
        data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)
    return Binary(data)


def input_of(chance: random.Random) -> tuple[bytes, bool]:
    """One input, and whether it is a valid message with one field mutated."""
    kind = chance.random()
    if kind < 0.6:
        return mutated(chance), True
    if kind < 0.65:
        return chance.choice(TEXTS), False
    if kind < 0.9:
        return wrecked(chance), False
    return packed(chance), False


class Target:
    """A console with a client that is fuzzed and others who see what comes of it."""

    def __init__(self) -> None:
        self.bridge = ConsoleBridge(BridgeProfile())
        router = self.bridge.router
        router.access = Access({"t" * 16: Role.CONTROL}, Role.CONTROL)
        self.client = router.connect("fuzz")
        self.others = [router.connect("json"), router.connect("ros1", dialect="ros1")]
        for other in self.others:
            for topic, kind in (("/relayed", "nav_msgs/Odometry"), ("/scan", "sensor_msgs/LaserScan")):
                self.say(other, {"op": "subscribe", "topic": topic, "type": kind, "queue_length": 1})
        self.say(self.others[0], {"op": "subscribe", "topic": "/octets", "type": "std_msgs/UInt8MultiArray"})
        self.say(self.client, {"op": "set_level", "level": "info"})

    def say(self, session: Any, operation: dict[str, Any]) -> None:
        assert self.bridge.receive(session, json.dumps(operation).encode(), 0).kind == "done"

    def take(self, data: bytes, now_ns: int) -> str:
        """Apply one input; read whatever it makes the console send, strictly."""
        kind = self.bridge.receive(self.client, data, now_ns).kind
        for session in (self.client, *self.others):
            while (text := session.next_text(now_ns)) is not None:
                if not isinstance(text, Binary):
                    orjson.loads(text)
        command = self.bridge.inputs.command
        if command.sequence or command.refused:
            assert math.isfinite(sum(command)), (data, command)
        return kind


def timed(target: Target, data: bytes, now_ns: int) -> float:
    """The processor time that an input takes, in s."""
    before_s = process_time()
    target.take(data, now_ns)
    return process_time() - before_s


@pytest.mark.fault("N07")
@pytest.mark.timeout(7200)
def test_n07_inputs_by_volume(sample: Sample, measured: Measured) -> None:
    inputs, seed = sample.of(50_000, 10_000_000), sample.seed
    chance = random.Random(seed)
    counted: dict[str, int] = {}
    near = now_ns = slow = 0
    longest_s, longest = 0.0, b""
    target = Target()
    began_s = process_time()
    for number in range(inputs):
        if number % EACH == 0:
            target = Target()
        data, is_near = input_of(chance)
        near += is_near
        now_ns += 10_000_000
        before_s = process_time()
        try:
            kind = target.take(data, now_ns)
        except BaseException:
            print("input", number, data)
            raise
        took_s = process_time() - before_s
        slow += took_s > SLOW_S
        if took_s > longest_s:
            # A collection of pytest's heap or a type's first use may fall upon it: what it costs, it costs again.
            again_s = min(timed(target, data, now_ns) for _ in range(5))
            longest_s, longest = max((longest_s, longest), (min(took_s, again_s), data))
        counted[kind] = counted.get(kind, 0) + 1
    spent_s = process_time() - began_s
    print(counted, f"longest {longest[:40]!r}")
    assert near >= inputs // 2
    assert min(counted[kind] for kind in ("done", "command", "refused")) > inputs // 100
    seen = f"0 uncaught, 0 non-finite out, {near} near to valid; {1e6 * spent_s / inputs:.0f} us of CPU time each"
    measured("N07", f"{inputs} inputs", seen, "none")
    seen = (
        f"{1e6 * slow / inputs:.0f} of a million cost more than 1 ms of CPU time, the longest {1e3 * longest_s:.1f} ms"
    )
    measured("N07", "costly inputs", seen, "0.1 %, 10 ms")
    assert slow <= 0.001 * inputs
    assert longest_s <= LONGEST_S, longest
