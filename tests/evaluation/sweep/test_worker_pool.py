import os
import signal
import threading
from pathlib import Path

import msgspec
import pytest

from simconsole.evaluation.sweep import lane as lane_module
from simconsole.evaluation.sweep.lane import Lane, Lanes
from simconsole.evaluation.sweep.task import Task, TaskResult, drive_task
from tests.evaluation.sweep.plans import grip
from tests.patience import wait_until


def test_a_lane_drives_one_task_after_the_other_as_this_process_does(tmp_path: Path) -> None:
    first, *_, last = grip(tmp_path).tasks
    lane = Lane()
    try:
        assert [lane.drive(first), lane.drive(last)] == [drive_task(first), drive_task(last)]
    finally:
        lane.close()


def test_a_lane_that_is_killed_in_a_drive_loses_it_and_the_next_lane_drives_it(tmp_path: Path) -> None:
    (task, *_) = grip(tmp_path, duration_s=100.0).tasks
    lanes = Lanes()
    found: list[TaskResult] = []
    short = msgspec.structs.replace(task, resolved=grip(tmp_path / "short").tasks[0].resolved)
    driving = threading.Thread(target=lambda: found.append(lanes.drive(task)))
    try:
        lanes.drive(short)  # of another thread, which stays
        driving.start()
        wait_until(lambda: len(lanes._all) == 2, "a second lane")
        (lane,) = lanes._all - {lanes._of_thread.lane}
        os.kill(lane._process.pid, signal.SIGKILL)
        driving.join()
        assert found[0].outcome == "driven"
        assert lane not in lanes._all
    finally:
        lanes.close()


def test_a_drive_that_takes_too_long_is_given_up_twice(tmp_path: Path) -> None:
    (task, *_) = grip(tmp_path, duration_s=80_000.0, timeout_s=0.5).tasks
    lanes = Lanes()
    try:
        result = lanes.drive(task)
    finally:
        lanes.close()
    assert (result.outcome, result.detail) == ("timed out", "twice, after 0.5 s")


class Dying:
    """A lane that always dies."""

    gave_up = False
    started = 0

    def __init__(self) -> None:
        Dying.started += 1

    def drive(self, task: Task) -> TaskResult | None:
        return None

    def close(self) -> None:
        pass


def test_a_drive_that_takes_every_lane_down_is_tried_twice(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lane_module, "Lane", Dying)
    result = Lanes().drive(grip(tmp_path).tasks[0])
    assert (result.outcome, Dying.started) == ("crashed", 2)


def test_closed_lanes_start_no_others(tmp_path: Path) -> None:
    lanes = Lanes()
    lanes.close()
    with pytest.raises(InterruptedError):
        lanes.drive(grip(tmp_path).tasks[0])
