"""What the driver's display knows of CAN bus and bridge: what the worker last wrote, and that it still writes."""

import os
from pathlib import Path

import numpy as np

from simconsole.processes.byte_slot import ByteSlot
from simconsole.processes.shared_memory import Ring
from simconsole.session.worker_programs import (
    ROAD_USERS,
    ROAD_USERS_CAPACITY,
    SIGNALS,
    CanWatch,
    LinkWatch,
    RoadUsersRing,
)
from simconsole.values.signals import FAR
from simconsole.world.roads.running import NONE_RUNNING, Running, changes
from simconsole.world.traffic.road_users import FIELDS, RECORD_WIDTH, to_record


def test_bus_is_up_only_while_its_worker_says_so(tmp_path: Path) -> None:
    path, clock = tmp_path / "can.json", [100.0]
    watch = CanWatch(path, lambda: clock[0], lambda: clock[0])

    def look(step_s: float) -> bool:
        clock[0] += step_s
        return watch()

    def write(text: str) -> None:
        path.write_text(text)
        os.utime(path, (clock[0], clock[0]))

    assert not look(0.0), "no file yet"
    write('{"up": true}')
    assert not look(0.11), "looked at not more often than five times a second"
    assert look(0.11)
    write('{"up": false}')
    assert not look(0.21)
    write('{"up": true}')
    assert look(0.21)
    assert look(2.5)
    assert not look(0.5), "a worker that writes no more"
    write("{")
    assert not look(0.21)


def test_link_stands_as_the_bridge_says_and_is_down_when_it_says_nothing(tmp_path: Path) -> None:
    path, clock = tmp_path / "link.json", [100.0]
    watch = LinkWatch(path, lambda: clock[0], lambda: clock[0])
    assert watch() == "down"
    clock[0] += 0.3
    path.write_text('{"state": "2 clients"}')
    os.utime(path, (clock[0], clock[0]))
    assert watch() == "2 clients"
    clock[0] += 3.1
    assert watch() == "down"
    path.write_text("[]")
    os.utime(path, (clock[0], clock[0]))
    clock[0] += 0.3
    assert watch() == "down", "not a status at all"


def test_road_users_reach_a_worker_whole_and_in_order(tmp_path: Path) -> None:
    ring = Ring.create(tmp_path / ROAD_USERS, RECORD_WIDTH, ROAD_USERS_CAPACITY)
    worker = RoadUsersRing(tmp_path)
    assert len(worker.newest().users) == 0
    assert worker.since() == []
    before, newest = worker.newest_two()
    assert before is None
    assert len(newest.users) == 0
    for step in range(1, 4):
        ring.write(to_record(np.full((step, FIELDS), float(step))), stamp=10 * step)
    assert worker.newest().tick == 30
    before, newest = worker.newest_two()
    assert before is not None
    assert (before.tick, newest.tick) == (20, 30)
    assert worker.newest().users.tolist() == [[3.0] * FIELDS] * 3
    assert [(at.tick, len(at.users)) for at in worker.since()] == [(10, 1), (20, 2), (30, 3)]
    assert worker.since() == []


def test_signals_of_another_simulator_come_with_the_road_users(tmp_path: Path) -> None:
    ring = Ring.create(tmp_path / ROAD_USERS, RECORD_WIDTH, ROAD_USERS_CAPACITY)
    slot = ByteSlot.create(tmp_path / SIGNALS, 1000)
    follower = RoadUsersRing(tmp_path)
    assert follower.newest().signals == {}
    now = {"a": Running("Gr", (), 0, FAR)}
    slot.write(3, changes(NONE_RUNNING, now) or b"")
    ring.write(to_record(np.ones((2, FIELDS))), 3)
    assert follower.newest().signals == now
    assert follower.newest().signals is follower.newest_two()[1].signals
    assert [at.signals for at in follower.since()] == [now]
    slot.write(4, b"{}")
    assert follower.signals() == {}


def test_each_step_has_the_signals_of_its_own_time(tmp_path: Path) -> None:
    ring = Ring.create(tmp_path / ROAD_USERS, RECORD_WIDTH, ROAD_USERS_CAPACITY)
    slot = ByteSlot.create(tmp_path / SIGNALS, 1000)
    follower = RoadUsersRing(tmp_path)
    shown = {10: "r", 30: "G", 50: "y"}
    for tick in range(10, 61, 10):
        if tick in shown:
            slot.write(tick, changes(NONE_RUNNING, {"a": Running(shown[tick], (), 0, FAR)}) or b"")
        ring.write(to_record(np.ones((2, FIELDS))), tick)
    steps = [(at.tick, at.signals["a"].letters) for at in follower.since()]
    assert steps == [(10, "r"), (20, "r"), (30, "G"), (40, "G"), (50, "y"), (60, "y")]
    slot.write(70, changes(NONE_RUNNING, {"a": Running("r", (), 0, FAR)}) or b"")
    assert follower.newest().signals["a"].letters == "y", "the record of that step is still to come"
    assert follower.signals()["a"].letters == "r"
    ring.write(to_record(np.ones((2, FIELDS))), 70)
    before, newest = follower.newest_two()
    assert before is not None
    assert [at.signals["a"].letters for at in (before, newest)] == ["y", "r"]


def test_of_a_step_from_before_all_signals_that_are_still_there_it_has_the_oldest(tmp_path: Path) -> None:
    ring = Ring.create(tmp_path / ROAD_USERS, RECORD_WIDTH, ROAD_USERS_CAPACITY)
    slot = ByteSlot.create(tmp_path / SIGNALS, 1000)
    for tick in range(1, 9):
        slot.write(tick, changes(NONE_RUNNING, {"a": Running("G", (), tick, FAR)}) or b"")
        ring.write(to_record(np.ones((2, FIELDS))), tick)
    assert [at.signals["a"].phase for at in RoadUsersRing(tmp_path).since()] == [6, 6, 6, 6, 6, 6, 7, 8]
