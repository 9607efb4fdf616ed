"""N07, N09, N11, N14, N17, N18: whatever a client sends is refused or harmless; the next valid command is applied."""

import json
import math
import random
from collections.abc import Callable
from time import thread_time_ns
from typing import Any

import cbor2
import pytest

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.protocol.fragments import MAX_OPEN, TIMEOUT_NS
from simconsole.bridge.protocol.message_decoding import Binary
from simconsole.profiles.bridge import BridgeLimits, BridgeProfile
from tests.bridge.fixtures import Peer
from tests.faults.wrecks import wreck
from tests.samples import Measured, Sample

CONTROL = "/control/command/control_cmd"
BAR_MS = 1.0
"""The most that a frame may cost, in ms of processor time."""
LARGE_BYTES = 10_000
ATOMS: list[Any] = [
    None, True, -1, 0, 1e308, 5e-324, 2**63, 2**64, -(2**63) - 1, 10**400, "", "x", "NaN", "\u0000", [], {}, [[]], [{}],
    {"x": 1}, "1", 1.5, "/clock", "é€𝄞",
]  # fmt: skip


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
    return wreck(chance, json.dumps(valid(0)).encode(), 4)


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


def sent(peer: Any, text: bytes | Binary) -> tuple[Any, float]:
    """Send a text; return what became of it and the processor time that it took, in ms."""
    began_ns = thread_time_ns()
    outcome = peer.send(text)
    return outcome, (thread_time_ns() - began_ns) / 1e6


def cost_ms(bridge: ConsoleBridge, text: bytes | Binary) -> float:
    """Return what a text costs, sent by clients that sent nothing before; the least of five.

    A collection of pytest's heap or a type's first use may fall upon one of them: what it costs, it costs again.
    """
    return min(sent(Peer(bridge), text)[1] for _ in range(5))


def check_after(peer: Any, text: bytes | Binary, number: int, took_ms: list[float] | None = None) -> str:
    """Send a bad text and a valid command; the bad one leaves a defined state, the valid one is applied."""
    before = peer.bridge.inputs.command
    outcome, cpu_ms = sent(peer, text)
    if took_ms is not None:
        took_ms.append(cpu_ms if cpu_ms <= BAR_MS else cost_ms(ConsoleBridge(BridgeProfile(port=0)), text))
    after = peer.bridge.inputs.command
    if outcome.kind == "refused":
        assert after._replace(refused=0.0) == before._replace(refused=0.0)
        assert peer.session.send_queue.take(peer.now_ns) is not None
    assert all(map(math.isfinite, after))
    peer.now_ns += 10**9
    assert peer.send(json.dumps(valid(number))).kind == "command"
    assert peer.bridge.inputs.command.accel_mps2 == number % 10
    while peer.session.next_text(peer.now_ns) is not None:
        pass
    return str(outcome.kind)


@pytest.mark.fault("N07")
@pytest.mark.parametrize("wreck", [wreck_text, wreck_field])
def test_n07_thousand_kinds_of_malformed_frame(
    peer: Any, wreck: Callable[[random.Random], bytes], sample: Sample, measured: Measured
) -> None:
    wanted = sample.of(1000, 10_000)
    chance = random.Random(sample.seed)
    kinds: set[bytes] = set()
    took_ms: list[float] = []
    refused = 0
    for _ in range(4 * wanted):
        text = wreck(chance)
        if text not in kinds:
            kinds.add(text)
            refused += check_after(peer, text, len(kinds), took_ms) == "refused"
        if refused == wanted:
            break
    assert refused == peer.session.refused == wanted
    took_ms.sort()
    seen = f"median {took_ms[len(took_ms) // 2]:.3f} ms, longest of {len(took_ms)} {took_ms[-1]:.2f} ms of CPU time"
    measured("N07", f"malformed frame, {wreck.__name__.replace('wreck_', '')}", seen, "1 ms")
    assert took_ms[-1] <= BAR_MS


@pytest.mark.fault("N09")
@pytest.mark.fault("N18")
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
def test_n09_n18_known_ways_to_hurt_a_parser(peer: Any, text: bytes) -> None:
    took_ms: list[float] = []
    assert check_after(peer, text, 3, took_ms) == "refused"
    assert took_ms[0] <= BAR_MS


@pytest.mark.fault("N09")
@pytest.mark.parametrize("opening", [b"[", b'{"op":', b'{"op":"publish","topic":"/a","type":"std_msgs/String","msg":['])
def test_n09_any_depth_costs_no_more_than_its_bytes(bridge: ConsoleBridge, opening: bytes, measured: Measured) -> None:
    """Up to the longest message that is taken, 256 KiB."""
    most = 262_144 // len(opening)
    took_ms = {depth: cost_ms(bridge, opening * depth) for depth in (1000, 10_000, min(100_000, most), most)}
    seen = f"{max(took_ms.values()):.3f} ms of CPU time"
    measured("N09", f"nested up to {most} deep", seen, "1 ms")
    assert max(took_ms.values()) <= BAR_MS, took_ms


@pytest.mark.fault("N07")
def test_n07_half_of_a_message_is_never_completed_by_the_next(peer: Any) -> None:
    text = json.dumps(valid(0)).encode()
    assert peer.send(text[:50]).kind == "refused"
    assert peer.send(text[50:]).kind == "refused"
    assert peer.bridge.inputs.command.sequence == 0.0


@pytest.mark.fault("N07")
def test_n07_fuzzed_relay_sends_only_valid_json(bridge: ConsoleBridge, join: Callable[..., Any]) -> None:
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


@pytest.mark.fault("N11")
@pytest.mark.parametrize(
    "data",
    [
        b"\x9b\x7f" + b"\xff" * 7,
        b"\xbb\x7f" + b"\xff" * 7,
        b"\x5b\x7f" + b"\xff" * 7,
        b"\x7b\x7f" + b"\xff" * 7,
        b"\x81" * 262_144,
        b"\xa1\x61a" * 60_000,
        b"\xa1\x61a\xc2\x5a\x00\x03\xff\x00" + b"\xff" * 0x3FF00,
        b"\xa1\x61a\xd8\x1d\x00",
        b"\xa1\x61a\xd9\x01\x00\x81\xd8\x19\x00",
        b"\xa1\x61a\xd8\x23\x64(a+)",
        b"\x9f" * 1000,
        cbor2.dumps({**valid(0), "msg": cbor2.CBORTag(2, b"x")}),
        cbor2.dumps(valid(0))[:-1],
        cbor2.dumps(valid(0)) * 2,
        cbor2.dumps([valid(0)]),
        cbor2.dumps(json.loads(json.dumps(valid(0)).replace("0.1", "NaN"))),
        cbor2.dumps(json.loads(json.dumps(valid(0)).replace("0.0", "Infinity"))),
    ],
    ids=range(17),
)
def test_n11_cbor_bombs(peer: Any, data: bytes, measured: Measured) -> None:
    took_ms: list[float] = []
    assert check_after(peer, Binary(data), 3, took_ms) == "refused"
    if len(data) > LARGE_BYTES:
        measured("N11", f"bomb of {len(data)} bytes", f"{took_ms[0]:.3f} ms of CPU time", "1 ms")
    assert took_ms[0] <= BAR_MS


@pytest.mark.fault("N11")
def test_n11_cbor_command_is_a_command(peer: Any) -> None:
    assert check_after(peer, Binary(cbor2.dumps(valid(7))), 8) == "command"


def fragment(identifier: str, number: int, total: int, data: str = "x") -> dict[str, Any]:
    return {"op": "fragment", "id": identifier, "num": number, "total": total, "data": data}


@pytest.mark.fault("N14")
def test_n14_missing_pieces_are_forgotten(bridge: ConsoleBridge, join: Callable[..., Any]) -> None:
    peer, sets = join(bridge), 10_000
    for number in range(sets):
        peer.now_ns += TIMEOUT_NS // 100
        peer.send(**fragment(f"f{number}", 0, 2, "x" * 1000))
    assert peer.session.assembler.held <= MAX_OPEN * 1000
    assert peer.session.refused > 0.9 * sets
    peer.now_ns += TIMEOUT_NS + 1
    assert check_after(peer, json.dumps(fragment("new", 0, 2)).encode(), 3) == "done"
    assert peer.session.assembler.held == 1


@pytest.mark.fault("N14")
def test_n14_all_pieces_together_are_bounded(join: Callable[..., Any]) -> None:
    peer = join(ConsoleBridge(BridgeProfile(limits=BridgeLimits(message_bytes=2048))))
    for number in range(MAX_OPEN):
        peer.send(**fragment(f"f{number}", 0, 9, "x" * 300))
    assert peer.session.assembler.held <= 2048
    assert peer.session.refused == 2


@pytest.mark.fault("N14")
def test_n14_pieces_of_two_clients_are_never_joined(bridge: ConsoleBridge, join: Callable[..., Any]) -> None:
    first, second = join(bridge), join(bridge)
    text = json.dumps(valid(0))
    assert first.send(**fragment("same", 0, 2, text[:60])).kind == "done"
    assert second.send(**fragment("same", 1, 2, text[60:])).kind == "done"
    assert bridge.inputs.command.sequence == 0.0
    assert first.send(**fragment("same", 1, 2, text[60:])).kind == "command"
    assert bridge.inputs.command.sequence == 1.0


@pytest.mark.fault("N14")
def test_n14_pieces_end_with_their_client(bridge: ConsoleBridge, join: Callable[..., Any]) -> None:
    first = join(bridge)
    text = json.dumps(valid(0))
    first.send(**fragment("a", 0, 2, text[:60]))
    bridge.disconnect(first.session, 0)
    join(bridge).send(**fragment("a", 1, 2, text[60:]))
    assert bridge.inputs.command.sequence == 0.0


@pytest.mark.fault("N17")
@pytest.mark.parametrize("op", ["subscribe", "advertise"])
def test_n17_ten_thousand_topics_are_too_many(peer: Any, op: str) -> None:
    for number in range(10_000):
        peer.send(op=op, topic=f"/t{number}", type="std_msgs/String")
    limit = 256
    assert len(peer.bridge.router.topics) <= limit
    assert peer.session.refused >= 10_000 - limit
    assert check_after(peer, b"{}", 3) == "refused"


@pytest.mark.fault("N17")
def test_n17_same_subscription_many_times_is_one_delivery(bridge: ConsoleBridge, join: Callable[..., Any]) -> None:
    peer, talker = join(bridge), join(bridge)
    for number in range(10_000):
        peer.send(op="subscribe", topic="/t", type="std_msgs/String", id="same" if number % 2 else f"i{number}")
    assert len(peer.session.queues["/t"].subscriptions) == 256
    peer.heard()
    talker.publish("/t", {"data": "x"})
    assert [message["op"] for message in peer.heard()] == ["publish"]


@pytest.mark.fault("N17")
@pytest.mark.parametrize(
    "operation",
    [
        {"op": "unsubscribe", "topic": "/never"},
        {"op": "unsubscribe", "topic": "/odom", "id": "never"},
        {"op": "unadvertise", "topic": "/never"},
        {"op": "unadvertise_service", "service": "/never"},
        {"op": "unadvertise_action", "action": "/never"},
        {"op": "subscribe", "topic": "/a/../b", "type": "std_msgs/String"},
        {"op": "subscribe", "topic": "/" + "x" * 100_000, "type": "std_msgs/String"},
        {"op": "subscribe", "topic": "/" + "x" * 256, "type": "std_msgs/String"},
        {"op": "subscribe", "topic": "", "type": "std_msgs/String"},
        {"op": "subscribe", "topic": "/", "type": "std_msgs/String"},
        {"op": "subscribe", "topic": "/a//b", "type": "std_msgs/String"},
        {"op": "subscribe", "topic": "/a b", "type": "std_msgs/String"},
        {"op": "subscribe", "topic": "/a\u0000", "type": "std_msgs/String"},
        {"op": "subscribe", "topic": "/ä", "type": "std_msgs/String"},
        {"op": "advertise", "topic": "~/a", "type": "std_msgs/String"},
        {"op": "advertise_service", "service": "/a/../b", "type": "std_srvs/Empty"},
        {"op": "call_service", "service": "x" * 1000},
    ],
    ids=range(17),
)
def test_n17_names_and_ids_that_are_none(peer: Any, operation: dict[str, Any]) -> None:
    before = set(peer.bridge.router.topics)
    assert check_after(peer, json.dumps(operation).encode(), 3) == "refused"
    assert set(peer.bridge.router.topics) == before


@pytest.mark.fault("N18")
@pytest.mark.parametrize(
    "text",
    [
        json.dumps(valid(0)).replace('"msg"', '"msg": {}, "msg"').encode(),
        json.dumps(valid(0)).replace('"op"', '"op": "subscribe", "op"').encode(),
        json.dumps(valid(0)).replace('"stamp"', '"st\\u0061mp": {}, "stamp"').encode(),
        b"\xef\xbb\xbf" + json.dumps(valid(0)).encode(),
        json.dumps(valid(0)).replace("i0", "\x00").replace("\\u0000", "\x00").encode(),
        json.dumps(valid(0)).encode().replace(b"i0", b"\xc0\xaf"),
        json.dumps(valid(0)).replace("i0", "\\udc00\\ud800").encode(),
    ],
    ids=["msg-twice", "op-twice", "escaped-key-twice", "mark", "nul", "overlong", "surrogates"],
)
def test_n18_json_that_readers_read_differently(peer: Any, text: bytes) -> None:
    assert check_after(peer, text, 3) == "refused"
