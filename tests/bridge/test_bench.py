from collections.abc import Callable
from typing import Any

import pytest

from simconsole.bridge.bench import Case, bench
from simconsole.errors import BridgeError


def test_all_servers_are_measured_in_all_cases(serving: Callable[..., Any]) -> None:
    found = bench(rounds=1, seconds=0.05, url=serving().url)
    cases = [("odometry", 1), ("odometry", 10), ("laser_scan", 1)]
    assert set(found) == {Case(server, *case) for server in ("bare", "simconsole", "url") for case in cases}
    for figures in found.values():
        assert figures.rate_hz > 0.0
        assert 0.0 < figures.p50_ms <= figures.p99_ms


def test_nobody_there() -> None:
    with pytest.raises(BridgeError, match=r"ws://127\.0\.0\.1:1"):
        bench(rounds=1, seconds=0.01, url="ws://127.0.0.1:1")
