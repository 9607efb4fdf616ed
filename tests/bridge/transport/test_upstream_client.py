"""The console as a client of another server, over real sockets: a double that behaves as rosbridge_server does."""

import asyncio
import itertools
import json
import os
import signal
import subprocess
import sys
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager, contextmanager
from pathlib import Path
from typing import Any

import pytest
from websockets.asyncio.server import ServerConnection
from websockets.asyncio.server import serve as serve_websockets

from simconsole.bridge.protocol.backoff import Backoff
from simconsole.bridge.transport.lockstep_server import LockstepBridge
from simconsole.bridge.transport.server import BridgeServer
from simconsole.bridge.transport.upstream_client import UpstreamClient
from simconsole.profiles.bridge import BridgeProfile, UpstreamProfile
from simconsole.values.errors import ProfileError
from tests.paths import ROOT
from tests.patience import until
from tests.ports import free_port

CONTROL = "/control/command/control_cmd"


class Double:
    """A rosbridge server that never sends a status and keeps what it hears."""

    def __init__(self) -> None:
        self.operations: list[dict[str, Any]] = []
        self.headers: list[str | None] = []
        self.peers: list[ServerConnection] = []

    async def __call__(self, peer: ServerConnection) -> None:
        assert peer.request is not None
        self.headers.append(peer.request.headers.get("Authorization"))
        self.peers.append(peer)
        async for text in peer:
            self.operations.append(json.loads(text))

    def heard(self, op: str, topic: str) -> list[dict[str, Any]]:
        return [each for each in self.operations if (each["op"], each.get("topic")) == (op, topic)]


@asynccontextmanager
async def joined(double: Double, port: int = 0, **profile: Any) -> AsyncIterator[BridgeServer]:
    async with serve_websockets(double, "127.0.0.1", port) as far:
        url = f"ws://127.0.0.1:{next(iter(far.sockets)).getsockname()[1]}"
        server = BridgeServer(BridgeProfile(port=0, upstream=UpstreamProfile(url=url, **profile)))
        await server.start()
        try:
            yield server
        finally:
            await server.close()


def test_state_goes_there_and_commands_come_back(
    snapshot: Callable[..., Any], control: Callable[..., Any], tmp_path: Path
) -> None:
    (tmp_path / "token").write_text("secret-of-theirs\n")

    async def main() -> None:
        double = Double()
        async with joined(double, token=str(tmp_path / "token")) as server:
            await until(lambda: bool(double.heard("subscribe", CONTROL)))
            assert double.headers == ["Bearer secret-of-theirs"]
            assert server.console.router.upstream == "connected"
            server.publish(snapshot(5, x_m=7.0))
            await until(lambda: bool(double.heard("publish", "/odom")))
            assert double.heard("publish", "/odom")[0]["msg"]["pose"]["pose"]["position"]["x"] == 7.0
            await double.peers[0].send(json.dumps({"op": "publish", "topic": CONTROL, "msg": control(0.3)}))
            await until(lambda: server.console.inputs.command.road_wheel_rad == 0.3)

    asyncio.run(main())


def test_it_comes_back_with_everything_and_nobody_engaged(
    snapshot: Callable[..., Any], control: Callable[..., Any]
) -> None:
    async def main() -> None:
        double = Double()
        async with joined(double) as server:
            for number in range(3):
                await until(lambda: len(double.heard("subscribe", CONTROL)) == number + 1)  # noqa: B023  (ends here)
                await double.peers[-1].send(json.dumps({"op": "publish", "topic": CONTROL, "msg": control(number / 9)}))
                await until(lambda: server.console.inputs.command.sequence == number + 1)  # noqa: B023  (ends here)
                double.peers[-1].transport.abort()
                await until(lambda: server.console.router.upstream == "lost")
            assert server.console.router.desk.lease.holder(0) is None
            await until(lambda: server.console.router.upstream == "connected")
            server.publish(snapshot(5))
            await until(lambda: bool(double.heard("publish", "/odom")))
            assert len(double.heard("advertise", "/odom")) == 4

    asyncio.run(main())


SERVER = """
import sys
from simconsole.bridge.transport.server import serve
from simconsole.profiles.bridge import BridgeProfile
ignore = lambda *_: None
serve(BridgeProfile(port=int(sys.argv[1])), ignore, ignore, ignore, lambda: False)
"""


@contextmanager
def serving(port: int) -> Iterator["subprocess.Popen[bytes]"]:
    """A server in one process of its own."""
    words = [sys.executable, "-c", SERVER, str(port)]
    quiet = subprocess.DEVNULL
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    with subprocess.Popen(words, env=environment, stdin=quiet, stdout=quiet, stderr=quiet) as process:
        try:
            yield process
        finally:
            process.kill()


def test_a_server_that_is_killed_started_again_and_stopped(snapshot: Callable[..., Any]) -> None:
    port = free_port()

    async def main() -> None:
        server = BridgeServer(BridgeProfile(port=0, upstream=UpstreamProfile(url=f"ws://127.0.0.1:{port}")))
        await server.start()
        ticks = itertools.count(1)

        def is_in(state: str) -> bool:
            server.publish(snapshot(5 * next(ticks)))  # a drive goes on, whatever becomes of the server
            return server.console.router.upstream == state

        try:
            for _ in range(2):
                with serving(port):
                    await until(lambda: is_in("connected"))
                await until(lambda: is_in("lost"))
            with serving(port) as far:
                await until(lambda: is_in("connected"))
                far.send_signal(signal.SIGSTOP)
                await until(lambda: is_in("lost"))
                far.send_signal(signal.SIGCONT)
                await until(lambda: is_in("connected"))
        finally:
            await server.close()

    asyncio.run(main())


def test_nobody_there_is_no_reason_to_stop(snapshot: Callable[..., Any]) -> None:
    async def main() -> None:
        server = BridgeServer(BridgeProfile(port=0))
        profile = UpstreamProfile(url="ws://127.0.0.1:1")
        task = asyncio.create_task(UpstreamClient(server.console, profile, backoff=Backoff(0.001, 0.001)).run())
        await until(lambda: server.console.router.upstream == "connecting")
        await asyncio.sleep(0.01)
        assert not task.done()
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)

    asyncio.run(main())


@pytest.mark.parametrize("profile", [{"token": "/nowhere"}, {"certificate": "/nowhere", "url": "wss://ros:9090"}])
def test_what_cannot_be_used_is_one_line(profile: dict[str, Any]) -> None:
    async def main() -> None:
        console = BridgeServer(BridgeProfile(port=0)).console
        with pytest.raises(ProfileError, match=r"outputs\.bridge\.upstream: ws"):
            UpstreamClient(console, UpstreamProfile(**{"url": "ws://ros:9090", **profile}))

    asyncio.run(main())


def test_lockstep_waits_for_its_own_clients_only() -> None:
    with pytest.raises(ProfileError, match=r"outputs\.bridge\.upstream"):
        LockstepBridge(BridgeProfile(port=0, upstream=UpstreamProfile(url="ws://ros:9090")))
