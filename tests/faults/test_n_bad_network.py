"""N06 in whole drives: what the console makes of commands that a bad network delays, in simulated time.

TCP loses nothing; it sends again, later, and holds back all that was sent after. So does this network. Real packets
are lost on real sockets in test_n_connections.py.
"""

import json
import random
from collections import deque
from typing import NamedTuple

import numpy as np
import pytest

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.signals import EventInput, Mode, Reason, RemoteCommand
from tests.bridge.fixtures import Peer, make_snapshot
from tests.faults.at_speed import LEFT_WITHIN_S, SPEED_MPS, STALE_S, ready
from tests.samples import Measured, Sample

HZ = 250
NS = 10**9
PERIOD_TICKS = 5
CONTROL = "/control/command/control_cmd"
RESEND_S = 0.2
"""The shortest time after which Linux sends again (TCP_RTO_MIN); doubled each time."""
DRIVE_S = 8.0


class Network(NamedTuple):
    """One way of a connection."""

    loss: float
    delay_s: float
    bytes_per_s: float


NETWORKS = {
    "good": Network(0.0, 0.001, 1e9),
    "30 % loss": Network(0.3, 0.005, 1e9),
    "5 % loss": Network(0.05, 0.005, 1e9),
    "200 ms": Network(0.0, 0.2, 1e9),
    "1 Mbit/s, full": Network(0.0, 0.02, 125_000.0),
    "all of it": Network(0.3, 0.2, 125_000.0),
}
OTHERS_BYTES = {"1 Mbit/s, full": 1900, "all of it": 1000}
"""What else is sent over it with each command."""


class FarController:
    """Sends a command each 20 ms over a network to the console's bridge; the loop takes what has arrived.

    Its clock is /clock, which comes to it over the same delay.
    """

    def __init__(self, network: Network, start: int, clock: str, others_bytes: int, seed: int) -> None:
        self._network, self._others_bytes = network, others_bytes
        self._chance = random.Random(seed)
        self._peer = Peer(ConsoleBridge(BridgeProfile(sender_clock=clock, lease_ms=10_000.0)))  # type: ignore[arg-type]
        self._on_the_way: deque[tuple[float, int, bytes]] = deque()
        self._free_s = self._arrival_s = 0.0
        self._send(start, start / HZ)
        self._on_the_way[0] = (0.0, *self._on_the_way[0][1:])  # the first is there
        self.accepted: dict[int, int] = {}
        """By the tick that it came in, the stamp in ns of the newest accepted command."""

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        now_s = (tick - 1) / HZ
        self._peer.now_ns = (tick - 1) * NS // HZ
        self._peer.bridge.publish(make_snapshot(tick - 1, HZ), self._peer.now_ns)
        self._peer.bridge.inputs.tick = tick - 1
        if tick % PERIOD_TICKS == 0:
            self._send(tick - 1, now_s)
        while self._on_the_way and self._on_the_way[0][0] <= now_s:
            _, stamp_ns, text = self._on_the_way.popleft()
            if self._peer.send(text).kind == "command":
                self.accepted[tick] = stamp_ns
        return self._peer.bridge.inputs.take(tick)

    def _send(self, tick: int, now_s: float) -> None:
        stamp_ns = max(0, tick * NS // HZ - round(self._network.delay_s * NS))
        text = json.dumps(
            {
                "op": "publish",
                "topic": "/ackermann_cmd",
                "msg": {
                    "header": {"stamp": {"sec": stamp_ns // NS, "nanosec": stamp_ns % NS}, "frame_id": "base_link"},
                    "drive": {"steering_angle": 0.0, "speed": SPEED_MPS},
                },
            }
        ).encode()
        self._free_s = max(now_s, self._free_s) + (len(text) + self._others_bytes) / self._network.bytes_per_s
        came_s, wait_s = self._free_s + self._network.delay_s, RESEND_S
        while self._chance.random() < self._network.loss:
            came_s, wait_s = came_s + wait_s, 2.0 * wait_s
        self._arrival_s = max(self._arrival_s, came_s)  # in order: what is lost holds up what follows
        self._on_the_way.append((self._arrival_s, stamp_ns, text))


def judged(name: str, clock: str, seed: int) -> tuple[int, bool]:
    """Drive over a network; return the most ticks AUTONOMOUS after the last command, and whether autonomy ended."""
    at_speed = ready(HZ)
    start = at_speed.state.tick
    controller = FarController(NETWORKS[name], start, clock, OTHERS_BYTES.get(name, 0), seed)
    driven = at_speed.drive(controller, DRIVE_S)
    ticks, mode = np.array([start, *controller.accepted]), driven.column("arbitration.mode")
    autonomous = np.flatnonzero(mode == Mode.AUTONOMOUS) + start
    latest = ticks[np.searchsorted(ticks, autonomous, side="right") - 1]
    assert (driven.column("ros.age_ticks")[1:][mode[1:] == Mode.AUTONOMOUS] < LEFT_WITHIN_S * HZ + 1).all()
    stamps = list(controller.accepted.values())
    assert stamps == sorted(set(stamps)), "in order, each once"
    if clock == "console":
        assert all((tick - 1) * NS // HZ - stamp <= STALE_S * NS for tick, stamp in controller.accepted.items())
    left = np.flatnonzero(mode != Mode.AUTONOMOUS)
    if len(left):
        assert driven.column("arbitration.reason")[left[0]] in (Reason.COMMAND_STALE, Reason.COMMAND_INVALID)
        assert (mode[left[0] :] != Mode.AUTONOMOUS).all(), "nobody is engaged by commands that come again"
    return int((autonomous - latest).max()) + 1, bool(len(left))


@pytest.mark.fault("N06")
@pytest.mark.parametrize("clock", ["own", "console"])
def test_n06_rules_of_staleness_hold_over_a_bad_network(clock: str, sample: Sample, measured: Measured) -> None:
    chance = random.Random(sample.seed)
    drives, longest = sample.of(2, 40), 0
    ended = dict.fromkeys(NETWORKS, 0)
    for name in NETWORKS:
        for _ in range(drives):
            seed = chance.randrange(1 << 30)
            ticks, has_ended = judged(name, clock, seed)
            assert ticks <= LEFT_WITHIN_S * HZ + 1, (name, seed)
            ended[name] += has_ended
            longest = max(longest, ticks)
    assert (ended["good"], ended["30 % loss"], ended["all of it"]) == (0, drives, drives)
    told = ", ".join(f"{name} {count}" for name, count in ended.items())
    seen = f"{1e3 * longest / HZ:.0f} ms; autonomy ended in so many of {drives} drives: {told}"
    bar = f"{1e3 * (LEFT_WITHIN_S + 1 / HZ):.0f} ms"
    measured("N06", f"AUTONOMOUS after the last command, its stamps by the {clock} clock", seen, bar)
