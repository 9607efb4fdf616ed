"""Processor time of a measured server, as the system counts it."""

import os
from pathlib import Path

import pytest

from simconsole.bridge.tools.bench_servers import RunningServer


def server(process: int | None) -> RunningServer:
    return RunningServer("bare", "websockets", "ws://127.0.0.1:9", process)


def test_processor_time_is_that_of_user_and_system(monkeypatch: pytest.MonkeyPatch) -> None:
    fields = ["S", *map(str, range(4, 14)), "250", "150", "7"]
    monkeypatch.setattr(Path, "read_text", lambda path: f"12 (a) b)) {' '.join(fields)}\n")
    assert server(12).cpu_s() == 4.0, "a name may hold brackets and blanks"


def test_processor_time_of_a_process_that_is_not_there_is_unknown() -> None:
    assert server(2**30).cpu_s() is None
    assert server(None).cpu_s() is None
    own = server(os.getpid()).cpu_s()
    times = os.times()
    assert own is not None
    assert own <= times.user + times.system + 0.02
