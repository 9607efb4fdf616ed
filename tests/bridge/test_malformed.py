"""N07, N09, N18, R05: whatever a client sends is refused or harmless, and the next valid command is applied."""

import json
import math
import random
from collections.abc import Callable
from typing import Any

import pytest

from simconsole.bridge.console import ConsoleBridge

CONTROL = "/control/command/control_cmd"
ATOMS = [
    None, True, -1, 0, 1e308, 5e-324, 2**63, 2**64, -(2**63) - 1, 10**400, "", "x", "NaN", "\u0000", [], {}, [[]], [{}],
    {"x": 1}, "1", 1.5, "/clock", "é€𝄞",
]  # fmt: skip
WRECKS = [b"", b"\x00", b"\xff\xfe", b"\xef\xbb\xbf", b"{", b"}", b"[", b'"', b"\\", b"NaN", b"1e999", b"\xed\xa0\x80"]


def valid(number: int) -> dict[str, Any]:
    return {
        "op": "publish",
        "topic": CONTROL,
        "id": f"i{number}",
        "msg": {
            "stamp": {"sec": 1 + number, "nanosec": 5},
            "lateral": {"steering_tire_angle": 0.1, "steering_tire_rotation_rate": 0.0},
            "longitudinal": {"velocity": 1.0, "acceleration": number % 10, "jerk": 0.0},
        },
    }


def places(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    found = [path] if path else []
    if isinstance(value, dict):
        for key, part in value.items():
            found += places(part, (*path, key))
    return found


def wreck_text(chance: random.Random) -> bytes:
    """A valid text with a few bytes cut, put in or turned over."""
    text = bytearray(json.dumps(valid(0)).encode())
    for _ in range(chance.randint(1, 4)):
        at = chance.randrange(len(text) + 1)
        kind = chance.randrange(4)
        if kind == 0:
            del text[at:]
        elif kind == 1:
            text[at:at] = chance.choice(WRECKS)
        elif kind == 2:
            del text[at : at + chance.randint(1, 8)]
        elif text:
            text[min(at, len(text) - 1)] ^= 1 << chance.randrange(8)
    return bytes(text)


def wreck_field(chance: random.Random) -> bytes:
    """A valid message in which one or two fields are replaced, renamed or left out."""
    message = valid(0)
    for _ in range(chance.randint(1, 2)):
        *parents, last = chance.choice(places(message))
        holder = message
        for key in parents:
            holder = holder[key]
        kind = chance.randrange(4)
        if kind == 0:
            del holder[last]
        elif kind == 1:
            holder[f"{last}{chance.choice(ATOMS)}"] = holder.pop(last)
        else:
            holder[last] = chance.choice([*ATOMS, math.nan, math.inf, -math.inf])
    return json.dumps(message).encode("utf-8", "surrogatepass")


def check_after(peer: Any, text: bytes, number: int) -> str:
    """Send a bad text and a valid command; the bad one leaves a defined state, the valid one is applied."""
    before = peer.bridge.inputs.command
    outcome = peer.send(text)
    after = peer.bridge.inputs.command
    if outcome.kind == "refused":
        assert after._replace(refused=0.0) == before._replace(refused=0.0)
        assert peer.session.outgoing.take(peer.now_ns) is not None
    assert all(map(math.isfinite, after))
    peer.now_ns += 10**9
    assert peer.send(json.dumps(valid(number))).kind == "command"
    assert peer.bridge.inputs.command.accel_mps2 == number % 10
    while peer.session.next_text(peer.now_ns) is not None:
        pass
    return str(outcome.kind)


@pytest.mark.parametrize("wreck", [wreck_text, wreck_field])
def test_thousand_kinds_of_malformed_frame(peer: Any, wreck: Callable[[random.Random], bytes]) -> None:
    seed = 20_261_120
    print("seed", seed)
    chance = random.Random(seed)
    kinds: set[bytes] = set()
    refused = 0
    for _ in range(4000):
        text = wreck(chance)
        if text not in kinds:
            kinds.add(text)
            refused += check_after(peer, text, len(kinds)) == "refused"
        if refused == 1000:
            break
    assert refused == peer.session.refused == 1000


@pytest.mark.parametrize(
    "text",
    [
        b"",
        b"\x00" * 1000,
        b"[" * 200_000,
        b'{"op":' * 40_000,
        b'{"op":"publish","topic":"/control/command/control_cmd","msg":' + b'{"lateral":' * 1000 + b"1" + b"}" * 1001,
        b'{"op":"publish","topic":"' + b"x" * 200_000 + b'","msg":{}}',
        b'{"op":"' + b"x" * 200_000 + b'"}',
        b'{"op":"publish","topic":"/a/../b","msg":{}}',
        b'{"op":"status","level":"error","msg":' + b"9" * 5000 + b"}",
        json.dumps(valid(0)).replace("0.1", "1" * 5000).encode(),
        json.dumps(valid(0)).replace("0.1", "1e400").encode(),
        json.dumps(valid(0)).replace("0.1", "NaN").encode(),
        json.dumps(valid(0)).replace("0.1", "null").encode(),
        json.dumps(valid(0)).replace("0.1", '0.1, "steering_tire_angle": 0.2').encode(),
        json.dumps(valid(0)).replace("i0", "\\ud800").encode(),
        json.dumps(valid(0)).encode("utf-16"),
        json.dumps([valid(0)]).encode(),
        json.dumps(valid(0)).encode() * 2,
    ],
    ids=range(18),
)
def test_known_ways_to_hurt_a_parser(peer: Any, text: bytes) -> None:
    assert check_after(peer, text, 3) == "refused"


def test_half_of_a_message_is_never_completed_by_the_next(peer: Any) -> None:
    text = json.dumps(valid(0)).encode()
    assert peer.send(text[:50]).kind == "refused"
    assert peer.send(text[50:]).kind == "refused"
    assert peer.bridge.inputs.command.sequence == 0.0


def test_fuzzed_relay_sends_only_valid_json(bridge: ConsoleBridge, join: Callable[..., Any]) -> None:
    seed = 7
    print("seed", seed)
    chance = random.Random(seed)
    talker, listener = join(bridge), join(bridge)
    listener.send(op="subscribe", topic="/odom2", type="nav_msgs/Odometry", queue_length=1000)
    template = {"pose": {"pose": {"position": {"x": 1, "y": 2}}, "covariance": [0.0] * 36}, "child_frame_id": "b"}
    heard = 0
    for _ in range(2000):
        message = json.loads(json.dumps(template))
        *parents, last = chance.choice(places(message))
        holder = message
        for key in parents:
            holder = holder[key]
        holder[last] = chance.choice([*ATOMS, math.nan, math.inf])
        talker.send(json.dumps({"op": "publish", "topic": "/odom2", "msg": message}))
        heard += len(listener.heard())
    assert 100 < heard < 2000
    assert heard + talker.session.refused == 2000
