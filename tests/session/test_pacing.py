import json
import os
import subprocess
import sys
from typing import Any

import pytest

from simconsole.session.pacing import CATCH_UP_TICKS, Pacer, UnpacedPacer, realtime_hints
from simconsole.values.signals import Event

PERIOD_NS = 4_000_000  # 250 Hz


class Wall:
    """A clock that moves only when told to: by sleeping, by working, by oversleeping."""

    def __init__(self) -> None:
        self.now_ns = 7_000_000_123
        self.oversleep_ns = 0
        self.wakes_early = False
        self.slept: list[float] = []

    def read(self) -> int:
        return self.now_ns

    def sleep(self, duration_s: float) -> None:
        self.slept.append(duration_s)
        if self.wakes_early and len(self.slept) % 2:
            duration_s *= 0.9
        self.now_ns += round(duration_s * 1e9) + self.oversleep_ns

    def pacer(self, tick_hz: int = 250) -> Pacer:
        return Pacer(tick_hz, self.read, self.sleep)


def test_deadlines_are_absolute() -> None:
    wall = Wall()
    pacer = wall.pacer()
    pacer.wait()
    start_ns = wall.now_ns
    wall.oversleep_ns = 50_000
    for tick in range(1, 1001):
        wall.now_ns += 300_000  # work
        assert pacer.wait() == 0
        assert wall.now_ns == start_ns + tick * PERIOD_NS + 50_000  # lateness does not add up
    assert pacer.slipped_ticks == pacer.stalls == 0
    assert pacer.lateness.max_ns == 50_000
    assert pacer.work.max_ns == 300_000
    assert pacer.work.count == 1000


@pytest.mark.parametrize("tick_hz", [50, 250, 1000])
def test_a_sleep_that_ends_early_is_slept_again(tick_hz: int) -> None:
    wall = Wall()
    wall.wakes_early = True
    pacer = wall.pacer(tick_hz)
    pacer.wait()
    start_ns = wall.now_ns
    for tick in range(1, 4):
        pacer.wait()
        assert wall.now_ns == start_ns + tick * 1_000_000_000 // tick_hz
    assert len(wall.slept) == 6


def test_no_drift_over_eight_hours_at_a_rate_that_does_not_divide_a_second() -> None:
    wall = Wall()
    pacer = wall.pacer(333)
    pacer.wait()
    start_ns = wall.now_ns
    pacer._due = 8 * 3600 * 333
    pacer.wait()
    assert wall.now_ns - start_ns == 8 * 3600 * 1_000_000_000


@pytest.mark.parametrize("missed", range(1, CATCH_UP_TICKS + 1))
def test_few_late_ticks_all_run_at_once(missed: int) -> None:
    wall = Wall()
    pacer = wall.pacer()
    pacer.wait()
    start_ns = wall.now_ns
    wall.now_ns += (missed + 1) * PERIOD_NS
    for _ in range(missed + 1):
        pacer.wait()
    assert wall.slept == []
    pacer.wait()
    assert wall.now_ns == start_ns + (missed + 2) * PERIOD_NS
    assert pacer.slipped_ticks == 0


def test_after_a_stall_five_late_ticks_run_and_the_rest_is_a_slip() -> None:
    wall = Wall()
    pacer = wall.pacer()
    pacer.wait()
    wall.now_ns += 21 * PERIOD_NS  # the tick due after 1 period starts 20 periods late
    ran = 0
    while not wall.slept:
        assert pacer.wait() == 0  # 80 ms: no stall yet
        ran += 1
    assert ran - 2 == CATCH_UP_TICKS  # five late ticks, the one that is due now, and the one that slept
    assert pacer.slipped_ticks == 20 - CATCH_UP_TICKS
    assert pacer.stalls == 0


@pytest.mark.fault("P06")
@pytest.mark.parametrize("tick_hz", [50, 100, 250, 1000])
def test_p06_a_stall_above_100_ms_is_one_event(tick_hz: int) -> None:
    wall = Wall()
    pacer = wall.pacer(tick_hz)
    pacer.wait()
    wall.now_ns += 1_000_000_000 // tick_hz + 100_000_000
    assert pacer.wait() == 0  # exactly 100 ms late
    while not wall.slept:
        assert pacer.wait() == 0
    wall.now_ns += 1_000_000_000 // tick_hz + 500_000_000
    events = []
    wall.slept.clear()
    while not wall.slept:
        events.append(pacer.wait())
    assert events == [Event.LOOP_STALL, *[0] * (len(events) - 1)]
    assert pacer.stalls == 1
    assert len(events) - 2 == CATCH_UP_TICKS


def test_a_loop_that_is_always_too_slow_slips_and_never_piles_up() -> None:
    wall = Wall()
    pacer = wall.pacer()
    pacer.wait()
    for _ in range(200):
        wall.now_ns += 2 * PERIOD_NS
        pacer.wait()
    assert pacer.slipped_ticks == pytest.approx(200 - CATCH_UP_TICKS, abs=1)
    assert pacer.lateness.max_ns < (CATCH_UP_TICKS + 2) * PERIOD_NS


def test_the_summary_is_plain_json() -> None:
    wall = Wall()
    pacer = wall.pacer()
    wall.oversleep_ns = 80_000
    for _ in range(100):
        pacer.wait()
        wall.now_ns += 500_000
    summary: dict[str, Any] = json.loads(json.dumps(pacer.summary()))
    assert summary["lateness_us"]["max"] == 80.0
    assert summary["work_us"]["max"] == 500.0
    assert summary["slipped_ticks"] == summary["stalls"] == 0
    assert summary["lateness"].endswith("max 80 us")


def test_without_pacing_a_tick_is_always_due() -> None:
    pacer = UnpacedPacer()
    assert [pacer.wait() for _ in range(3)] == [0, 0, 0]
    assert pacer.summary() == {"lateness": "not paced"}


HINTS = """
import gc, json, os, resource, sys
from simconsole.session.pacing import CATCH_UP_TICKS, Pacer, UnpacedPacer, realtime_hints
if sys.argv[1] == "unprivileged":
    resource.setrlimit(resource.RLIMIT_RTPRIO, (0, 0))
    resource.setrlimit(resource.RLIMIT_MEMLOCK, (0, 0))
    if os.geteuid() == 0:
        os.setresgid(65534, 65534, 65534)
        os.setresuid(65534, 65534, 65534)
before = os.sched_getscheduler(0)
with realtime_hints() as missing:
    inside = os.sched_getscheduler(0) & ~os.SCHED_RESET_ON_FORK
    frozen = gc.get_freeze_count() > 0
after = os.sched_getscheduler(0) & ~os.SCHED_RESET_ON_FORK
print(json.dumps([missing, inside == os.SCHED_FIFO, frozen, after == before, gc.get_freeze_count()]))
"""


def hints(user: str) -> Any:
    words = [sys.executable, "-c", HINTS, user]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_real_time_hints_say_what_they_did_not_get_and_are_taken_back() -> None:
    missing, fifo, frozen, restored, left_frozen = hints("as it is")
    assert fifo == (not any("scheduling" in line for line in missing))
    assert frozen
    assert restored
    assert left_frozen == 0


def test_real_time_hints_without_any_privilege() -> None:
    missing, fifo, frozen, restored, _ = hints("unprivileged")
    assert missing == ["locked memory: not permitted", "real-time scheduling: Operation not permitted"]
    assert (fifo, frozen, restored) == (False, True, True)


LOCKED = """
import json, mmap
from pathlib import Path
from simconsole.session.pacing import realtime_hints

def kib(name):
    (line,) = [line for line in Path("/proc/self/status").read_text().splitlines() if line.startswith(name)]
    return int(line.split()[1])

used = mmap.mmap(-1, 32 << 20)
used.write(bytes(32 << 20))
reserved = mmap.mmap(-1, 512 << 20)  # as libraries reserve it, and never touch most of it
before_kib = kib("VmRSS")
with realtime_hints() as missing:
    print(json.dumps([missing, kib("VmRSS") - before_kib, kib("VmLck")]))
"""


def test_memory_that_is_locked_is_not_brought_in_for_that() -> None:
    done = subprocess.run([sys.executable, "-c", LOCKED], capture_output=True, text=True, check=True)
    missing, grown_kib, locked_kib = json.loads(done.stdout)
    assert grown_kib < 128 * 1024, "what was only reserved takes no memory"
    assert locked_kib > 32 * 1024 or any("locked memory" in line for line in missing)


def test_real_time_hints_of_a_user_who_may_not_clear_reset_on_fork_again(monkeypatch: pytest.MonkeyPatch) -> None:
    class Libc:
        def __getattr__(self, name: str) -> Any:
            return lambda *arguments: 0

    class Kernel:
        policy = os.SCHED_OTHER

        def set(self, process: int, policy: int, parameters: object) -> None:
            if self.policy & ~policy & os.SCHED_RESET_ON_FORK:  # sched(7): needs CAP_SYS_NICE
                raise PermissionError(1, "Operation not permitted")
            self.policy = policy

    kernel = Kernel()
    monkeypatch.setattr("ctypes.CDLL", lambda *arguments, **keywords: Libc())
    monkeypatch.setattr(os, "sched_getscheduler", lambda process: kernel.policy)
    monkeypatch.setattr(os, "sched_setscheduler", kernel.set)
    with realtime_hints() as missing:
        assert missing == []
        assert kernel.policy == os.SCHED_FIFO | os.SCHED_RESET_ON_FORK
    assert kernel.policy & ~os.SCHED_RESET_ON_FORK == os.SCHED_OTHER
