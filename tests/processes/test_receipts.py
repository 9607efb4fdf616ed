"""What a worker counts of the ticks that reach it."""

from pathlib import Path

import numpy as np
import pytest

from simconsole.processes.receipts import Receipts, latencies_of
from simconsole.processes.shared_memory import Record
from simconsole.session.worker_programs import LATENCY
from tests.values.test_latency import Clock


def record(number: int, published_ns: int) -> Record:
    return Record(number, number, published_ns, np.zeros(1))


@pytest.mark.parametrize(
    ("receive_ns", "draw_ns"), [(400_000, 2_000_000), (7_400_000, 2_000_000), (400_000, 9_000_000)]
)
def test_a_worker_that_is_late_is_found_at_receive_or_at_draw(tmp_path: Path, receive_ns: int, draw_ns: int) -> None:
    clock = Clock({})
    receipts = Receipts(tmp_path / f"{LATENCY}.hud.json", clock.read)
    for number in range(1, 200):
        published_ns = clock.now_ns
        clock.now_ns += receive_ns
        receipts.received(record(number, published_ns))
        clock.now_ns += draw_ns
        receipts.drawn()
        receipts.received(record(number, published_ns))  # the same again: neither received nor drawn
        receipts.drawn()
        clock.now_ns += 10_000_000
    found = latencies_of(tmp_path, LATENCY)
    assert list(found) == ["receive, hud", "draw, hud"]
    assert found["receive, hud"]["max"] == receive_ns / 1e3
    assert found["draw, hud"]["max"] == draw_ns / 1e3
    assert 80 < found["draw, hud"]["count"] < 200, "saved once a second, each picture once"


def test_a_full_disk_of_the_run_folder_harms_no_worker(tmp_path: Path) -> None:
    clock = Clock({})
    receipts = Receipts(tmp_path / "gone" / f"{LATENCY}.hud.json", clock.read)
    clock.now_ns += 2_000_000_000
    receipts.received(record(1, clock.now_ns))
    (tmp_path / "gone").mkdir()
    clock.now_ns += 2_000_000_000
    receipts.received(record(2, clock.now_ns))
    found = latencies_of(tmp_path / "gone", LATENCY)
    assert found["receive, hud"]["count"] == 2, "counted all the same, and saved when it can be"
