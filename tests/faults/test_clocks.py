"""P05 and P06: the wall clock jumps, the loop really stands still."""

from pathlib import Path

import numpy as np
import pytest

from simconsole.recording.bundles.bundle import open_bundle
from simconsole.session.pacing import CATCH_UP_TICKS, Pacer
from simconsole.values.signals import Event, Mode, Reason
from simconsole.values.state_vector import Snapshot
from tests.drives.console import results, simconsole, within
from tests.faults.course import BY_HAND, HZ, PLACES, circuit
from tests.faults.test_whole_drives import PERSON
from tests.paths import ROOT
from tests.patience import pause

JUMPING = '''
"""Python runs this before anything else: whoever reads the wall clock finds it an hour ahead, then an hour back."""
import atexit, datetime, os, sys, time

sys.modules["pandas"] = None  # pyarrow looks for it, and its compiled part knows no other datetime
reads = 0
time_s, time_ns = time.time, time.time_ns

def jump_s():
    global reads
    reads += 1
    return 3600 if reads % 2 else -3600

time.time = lambda: time_s() + jump_s()
time.time_ns = lambda: time_ns() + jump_s() * 10**9

class Jumping(datetime.datetime):
    @classmethod
    def now(cls, tz=None):
        return super().now(tz) + datetime.timedelta(seconds=jump_s())

datetime.datetime = Jumping

@atexit.register
def tell():
    with open(os.environ["JUMPS"], "a") as file:
        file.write(f"{reads}\\n")
'''
SESSION = """schema: 1
environment: {world: urban}
scenario: {vehicle: hatchback, duration_s: 6}
features: {autopilot: urban}
outputs: {bridge: {port: 0}, hud: null, scene: null, report: false}
devices: {driver: "script:person.yaml"}
mode: {pacing: lockstep}
"""


@pytest.mark.fault("P05")
def test_p05_wall_clock_that_jumps_by_an_hour_changes_not_one_bit(tmp_path: Path) -> None:
    """The console and the autopilot's own process, over a WebSocket: with a clock that jumps at every look."""
    (tmp_path / "sitecustomize.py").write_text(JUMPING)
    (tmp_path / "session.yaml").write_text(SESSION)
    (tmp_path / "person.yaml").write_text(PERSON)
    jumps = tmp_path / "jumps"
    root = str(ROOT)
    digests = []
    steady = within("drive", tmp_path / "session.yaml", "--out", tmp_path / "steady", "--json", "--no-pack")
    changes = {"PYTHONPATH": f"{tmp_path}:{root}", "JUMPS": str(jumps)}
    words = ("drive", tmp_path / "session.yaml", "--out", tmp_path / "jumping", "--json", "--no-pack")
    jumping = simconsole(*words, **changes)
    for done in (steady, jumping):
        assert done.returncode == 0, done.stderr
        digests.append(results(done)["digest"])
    reads = [int(line) for line in jumps.read_text().split()]
    print(f"the clock jumped {reads} times")
    assert len(reads) >= 2, "the console and the autopilot both had that clock"
    assert digests[0] == digests[1]
    modes = open_bundle(tmp_path / "jumping").log.table().column("arbitration.mode")
    assert modes[-1] == Mode.AUTONOMOUS


class Sleeper:
    """A output that really holds the loop up, once."""

    def __init__(self, tick: int, sleep_s: float) -> None:
        self._tick, self._sleep_s = tick, sleep_s

    def publish(self, snapshot: Snapshot) -> None:
        if snapshot.tick == self._tick:
            pause(self._sleep_s)


@pytest.mark.fault("P06")
def test_p06_loop_that_really_stands_for_half_a_second_is_answered_in_its_next_tick() -> None:
    """Real time, the real pacer: five late ticks run at once, the rest never happens, the car stops in its lane."""
    track = circuit()
    state = track.state_at(PLACES["bend"])
    held = state.tick + 100
    pacer = Pacer(HZ)
    driven = track.drive(state, 8.0, pace=pacer, outputs=(Sleeper(held, 0.5),))
    stalled = driven.column("events.events").astype(int) & int(Event.LOOP_STALL) != 0
    after = held - state.tick  # the row of the tick after it
    assert stalled[after]
    assert pacer.stalls == stalled.sum()
    assert pacer.slipped_ticks >= 0.5 * HZ - CATCH_UP_TICKS - 2
    first = int(np.flatnonzero(stalled)[0])
    mode, reason = driven.column("arbitration.mode"), driven.column("arbitration.reason")
    assert (mode[first], reason[first]) == (Mode.MINIMAL_RISK, Reason.LOOP_STALL)
    assert set(mode[:first]) <= {Mode.AUTONOMOUS}
    assert (driven.column("command.throttle")[first:] == 0.0).all()
    assert driven.at_rest
    assert abs(driven.lateral_m) < 0.5


@pytest.mark.fault("P06")
def test_p06_a_person_at_the_wheel_is_stopped_too_and_has_it_back_at_once() -> None:
    """By hand the stop is steered by the controller that agrees; the person's brake ends it."""
    track = circuit()
    state = track.state_at(PLACES["bend"])
    crew = BY_HAND._replace(attentive=True)
    driven = track.drive(state, 8.0, crew=crew, pace=Pacer(HZ), outputs=(Sleeper(state.tick + 250, 0.3),))
    assert driven.modes[:3] == [Mode.MANUAL, Mode.MINIMAL_RISK, Mode.MANUAL]
    assert driven.reasons[0] == Reason.LOOP_STALL
