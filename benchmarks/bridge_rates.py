"""Two rosbridge servers of ours in alternation: processor time for one message to one subscriber, second over first.

Run: python benchmarks/bridge_rates.py [TREE:]TRANSPORT [TREE:]TRANSPORT [--pairs N] [--subscribers N ...]
For example: python benchmarks/bridge_rates.py websockets picows
             python benchmarks/bridge_rates.py ../before:websockets .:websockets --subscribers 1 10

Both servers run all the time, each from its own checkout; the clients are this checkout's. An Odometry goes round in a
closed loop with 20 under way. Counted is the server's own time on the processor, so that the clients and a busy machine
do not decide. The interval is that of the median's order statistics (`two_trees.py`).
"""

import argparse
import asyncio
import os
import statistics
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import NamedTuple

from two_trees import interval

from simconsole.bridge.tools import bench
from simconsole.bridge.tools.bench_servers import RunningServer

SERVE = """
import sys
from simconsole.bridge.transport.server import serve
from simconsole.profiles.bridge import BridgeLimits, BridgeProfile

profile = BridgeProfile(port=0, transport=sys.argv[1], limits=BridgeLimits(clients=200))
ready = lambda port: print(port, flush=True)
serve(profile, lambda: None, lambda *_: None, lambda _: None, lambda: False, on_ready=ready)
"""


class Server(NamedTuple):
    """One that runs; counts in ns instead of the hundredths of a second of /proc/PID/stat."""

    running: RunningServer

    @property
    def url(self) -> str:
        return self.running.url

    def cpu_s(self) -> float:
        return sum(
            int((task / "schedstat").read_text().split()[0]) / 1e9
            for task in Path(f"/proc/{self.running.process}/task").iterdir()
        )


@contextmanager
def serving(what: str) -> Iterator[Server]:
    tree, _, transport = what.rpartition(":")
    around = {**os.environ, "PYTHONPATH": str(Path(tree or ".").resolve())}
    words = [sys.executable, "-c", SERVE, transport]
    with subprocess.Popen(words, env=around, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            port = process.stdout.readline().strip()
            if not port:
                raise SystemExit(f"{what}: does not start")
            yield Server(RunningServer(what, transport, f"ws://127.0.0.1:{port}", process.pid))
        finally:
            process.terminate()


def main() -> None:
    """Print, for each number of subscribers, both times and their ratio."""
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("servers", nargs=2, metavar="[TREE:]TRANSPORT")
    words.add_argument("--pairs", type=int, default=30)
    words.add_argument("--seconds", type=float, default=0.5)
    words.add_argument("--subscribers", type=int, nargs="+", default=[1, 10, 100])
    given = words.parse_args()
    with ExitStack() as stack:
        servers = [stack.enter_context(serving(what)) for what in given.servers]
        for subscribers in given.subscribers:
            found: list[list[bench.Measurement]] = [[], []]
            for pair in range(given.pairs + 1):
                for number in (0, 1) if pair % 2 else (1, 0):
                    figures = asyncio.run(bench.measure_once(servers[number], "odometry", subscribers, given.seconds))
                    if pair:  # the first pair fills caches
                        found[number].append(figures)
            tell(given.servers, subscribers, found)


def tell(servers: list[str], subscribers: int, found: list[list[bench.Measurement]]) -> None:
    times_us = [[float(figures.cpu_us or 0.0) for figures in several] for several in found]
    ratios = sorted(second / first for first, second in zip(*times_us, strict=True))
    low, high = interval(len(ratios))
    print(f"to {subscribers}:")
    for name, times, several in zip(servers, times_us, found, strict=True):
        rate_hz = statistics.median(figures.rate_hz for figures in several)
        p50_ms = statistics.median(figures.p50_ms for figures in several)
        cpu_us = statistics.median(times)
        print(f"  {name:24s} {cpu_us:6.1f} us each; {rate_hz:7.0f} /s to each, at 100 Hz p50 {p50_ms:.2f} ms")
    median = statistics.median(ratios)
    print(
        f"  second over first, median of {len(ratios)} pairs: {median:.3f} "
        f"(95 % interval {ratios[low]:.3f} to {ratios[high]:.3f})",
        flush=True,
    )


if __name__ == "__main__":
    main()
