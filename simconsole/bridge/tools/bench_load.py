"""What bad clients cost our own server: one that stops reading, one that sends commands without end.

Only against a server of our own, in a process of its own: what makes a peer fail is not published.
"""

import asyncio
import time
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, Final, NamedTuple

import orjson
from websockets.asyncio.client import connect

from simconsole.bridge.tools.bench_servers import server_process
from simconsole.values.errors import BridgeError
from simconsole.values.signals import RemoteCommand

MESSAGES: Final = 1000
MESSAGE_BYTES: Final = 20_000
FLOOD_HZ: Final = 10_000
TICK_S: Final = 0.01
_STATM_PAGE: Final = 4096
_CONTROL: Final = "/control/command/control_cmd"


class LoadResult(NamedTuple):
    """Lost by a healthy subscriber beside a stalled one, the server's growth; the applied command's age in a flood."""

    lost: int
    growth_mb: float
    sent_hz: float
    age_p50_ms: float
    age_p99_ms: float
    age_max_ms: float


def load(seconds: float = 3.0) -> LoadResult:
    """Measure both; the flood lasts `seconds`.

    Raises:
        BridgeError: the server does not start.
    """
    with server_process("simconsole", "websockets", _serve) as (server, pipe):
        lost, growth_mb = asyncio.run(_stall(server.url, server.process or 0))
        sent_hz = asyncio.run(_flood(server.url, seconds))
        pipe.send(None)
        ages_ms = sorted(pipe.recv())
    if not ages_ms:
        raise BridgeError("no command of the flood was applied")
    middle, high = ages_ms[len(ages_ms) // 2], ages_ms[int(0.99 * (len(ages_ms) - 1))]
    return LoadResult(
        lost=lost,
        growth_mb=growth_mb,
        sent_hz=sent_hz,
        age_p50_ms=middle,
        age_p99_ms=high,
        age_max_ms=ages_ms[-1],
    )


async def _stall(url: str, server: int) -> tuple[int, float]:
    subscribe = orjson.dumps({"op": "subscribe", "topic": "/load", "type": "std_msgs/String", "queue_length": MESSAGES})
    stalled = await connect(url, max_queue=1)
    await stalled.send(subscribe, text=True)
    stalled.transport.pause_reading()
    lost = 0
    async with connect(url) as healthy, connect(url) as talker:
        await healthy.send(subscribe, text=True)
        await healthy.send('{"op":"no_such"}')
        await healthy.recv()
        before_mb = _resident_mb(server)
        text = "x" * MESSAGE_BYTES
        for number in range(MESSAGES):
            message = {"op": "publish", "topic": "/load", "msg": {"data": f"{number} {text}"}}
            await talker.send(orjson.dumps(message), text=True)
            try:
                await asyncio.wait_for(healthy.recv(), 10.0)
            except TimeoutError:
                lost += 1
        growth_mb = _resident_mb(server) - before_mb
    stalled.transport.abort()
    return lost, growth_mb


async def _flood(url: str, seconds: float) -> float:
    command: dict[str, Any] = {
        "lateral": {"steering_tire_angle": 0.1},
        "longitudinal": {"acceleration": 0.0},
    }
    text = orjson.dumps({"op": "publish", "topic": _CONTROL, "msg": command})
    count = 0
    async with connect(url) as peer:
        began_s = time.monotonic()
        while (elapsed_s := time.monotonic() - began_s) < seconds:
            while count < elapsed_s * FLOOD_HZ:
                await peer.send(text, text=True)
                count += 1
            await asyncio.sleep(0.0005)
    return count / elapsed_s


def _resident_mb(process: int) -> float:
    return int(Path(f"/proc/{process}/statm").read_text().split()[1]) * _STATM_PAGE / 1e6


def _serve(pipe: Connection) -> None:
    from simconsole.bridge.transport.server import serve
    from simconsole.profiles.bridge import BridgeProfile

    ages_ms: list[float] = []
    newest_ns: int | None = None
    next_s = 0.0

    def keep(command: RemoteCommand, receipt_ns: int | None) -> None:
        """Remember when the command that a tick would take was received."""
        nonlocal newest_ns
        newest_ns = receipt_ns

    def tick() -> None:
        """Note, once a tick, how old that command is; there is no snapshot."""
        nonlocal next_s
        now_s = time.monotonic()
        if newest_ns is not None and now_s >= next_s:
            next_s = now_s + TICK_S
            ages_ms.append((time.monotonic_ns() - newest_ns) / 1e6)

    serve(BridgeProfile(port=0), tick, keep, lambda _: None, pipe.poll, on_ready=pipe.send)
    pipe.send(ages_ms[:-1])
