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


def test_a_restarted_worker_that_has_drawn_nothing_yet_leaves_what_the_one_before_it_had_counted(
    tmp_path: Path,
) -> None:
    """It takes seconds to open its window, and then receives before it draws."""
    clock, path = Clock({}), tmp_path / f"{LATENCY}.hud.json"
    before = Receipts(path, clock.read)
    for number in range(1, 200):
        clock.now_ns += 10_000_000
        before.received(record(number, clock.now_ns))
        before.drawn()
    counted = latencies_of(tmp_path, LATENCY)
    assert list(counted) == ["receive, hud", "draw, hud"]
    after = Receipts(path, clock.read)
    clock.now_ns += 3_000_000_000
    after.received(record(500, clock.now_ns))
    assert latencies_of(tmp_path, LATENCY) == counted
    after.drawn()
    clock.now_ns += 1_000_000_000
    after.received(record(750, clock.now_ns))
    found = latencies_of(tmp_path, LATENCY)
    assert (found["receive, hud"]["count"], found["draw, hud"]["count"]) == (2, 1)


def test_a_full_disk_of_the_run_folder_harms_no_worker(tmp_path: Path) -> None:
    clock = Clock({})
    receipts = Receipts(tmp_path / "gone" / f"{LATENCY}.hud.json", clock.read)
    for number in (1, 2):
        clock.now_ns += 2_000_000_000
        receipts.received(record(number, clock.now_ns))
    (tmp_path / "gone").mkdir()
    clock.now_ns += 2_000_000_000
    receipts.received(record(3, clock.now_ns))
    found = latencies_of(tmp_path / "gone", LATENCY)
    assert found["receive, hud"]["count"] == 3, "counted all the same, and saved when it can be"
