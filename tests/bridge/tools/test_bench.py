import asyncio
import threading
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import nullcontext

import orjson
import pytest
from websockets.asyncio.server import ServerConnection, serve

from simconsole.bridge.tools.bench import IN_FLIGHT, Case, bench
from simconsole.bridge.tools.bench_servers import RunningServer, running_servers
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.errors import BridgeError
from tests.bridge.fixtures import Served
from tests.patience import PATIENCE_S


@pytest.fixture(scope="module")
def servers() -> Iterator[list[RunningServer]]:
    """The servers that a benchmark starts: four processes, started once."""
    with running_servers() as started:
        yield started


@pytest.fixture(autouse=True)
def started(servers: list[RunningServer], monkeypatch: pytest.MonkeyPatch) -> None:
    """Let each benchmark find them started."""
    monkeypatch.setattr("simconsole.bridge.tools.bench.running_servers", lambda: nullcontext(list(servers)))


@pytest.fixture(params=["websockets", "picows"])
def clients(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """The benchmark's own clients by either library."""
    monkeypatch.setattr("simconsole.bridge.tools.bench_peers.library", lambda: request.param)


@pytest.mark.usefixtures("clients")
def test_all_servers_are_measured_in_all_cases(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("simconsole.bridge.tools.bench._SILENCE_S", 0.1)
    other = Served(BridgeProfile(port=0))
    try:
        found = bench(rounds=1, seconds=0.05, url=other.url)
    finally:
        other.stop()
    cases = [("odometry", 1), ("odometry", 10), ("laser_scan", 1)]
    servers = [(name, library) for name in ("bare", "simconsole") for library in ("websockets", "picows")]
    assert set(found) == {Case(*server, *case) for server in [*servers, ("url", "")] for case in cases}
    for case, figures in found.items():
        assert figures.rate_hz > 0.0
        assert (figures.cpu_us is None) == (case.server == "url")
        assert 0.0 < figures.p50_ms <= figures.p99_ms


@pytest.mark.usefixtures("clients")
def test_nobody_there() -> None:
    with pytest.raises(BridgeError, match=r"ws://127\.0\.0\.1:1"):
        bench(rounds=1, seconds=0.01, url="ws://127.0.0.1:1")


KEPT = 10


async def keep_the_newest(ready: Callable[[int], None], stop: threading.Event) -> None:
    """Serve as a ROS 2 graph behind a bridge does: a queue of KEPT for each subscriber, the oldest dropped."""
    queues: dict[ServerConnection, deque[str]] = {}

    async def client(peer: ServerConnection) -> None:
        async for text in peer:
            operation = orjson.loads(text)
            if operation["op"] == "subscribe":
                queues[peer] = deque(maxlen=KEPT)
            elif operation["op"] == "publish":
                for queue in queues.values():
                    queue.append(str(text))
        queues.pop(peer, None)

    async with serve(client, "127.0.0.1", 0, compression=None) as server:
        ready(next(iter(server.sockets)).getsockname()[1])
        while not stop.is_set():
            await asyncio.sleep(0.002)
            for peer, queue in list(queues.items()):
                while queue:
                    await peer.send(queue.popleft())


@pytest.fixture
def short_queues() -> Iterator[str]:
    ports: list[int] = []
    ready, stop = threading.Event(), threading.Event()

    def listening(port: int) -> None:
        ports.append(port)
        ready.set()

    def run() -> None:
        asyncio.run(keep_the_newest(listening, stop))

    thread = threading.Thread(target=run)
    thread.start()
    assert ready.wait(PATIENCE_S)
    yield f"ws://127.0.0.1:{ports[0]}"
    stop.set()
    thread.join()


def test_a_server_with_short_queues_is_measured_with_fewer_under_way(short_queues: str) -> None:
    found = bench(rounds=1, seconds=0.05, url=short_queues)
    for case, figures in found.items():
        assert figures.rate_hz > 0.0
        assert (figures.under_way < IN_FLIGHT) == (case.server == "url"), (case, figures)


def test_a_server_that_passes_nothing_on_is_left(short_queues: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("simconsole.bridge.tools.bench._TRIES", 2)
    monkeypatch.setattr("simconsole.bridge.tools.bench._text", lambda *_: b'{"op": "nothing"}')
    with pytest.raises(BridgeError, match="loses messages"):
        bench(rounds=1, seconds=0.01, url=short_queues)
