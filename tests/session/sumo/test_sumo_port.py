"""The core's side of SUMO's worker: it asks, takes what is there, and never waits."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

from simconsole.profiles.traffic import SumoProfile, TrafficProfile
from simconsole.session.sumo.sumo_memory import ERROR_AT, How, SumoMemory, signal_bytes, signals_within
from simconsole.session.sumo.sumo_port import SumoPort
from simconsole.values.errors import ProfileError
from simconsole.values.signals import FAR
from simconsole.world.roads.road_map import RoadMap
from simconsole.world.roads.running import Running
from simconsole.world.sumo_traffic import engines
from simconsole.world.traffic.road_users import FIELDS, RECORD_WIDTH, to_record
from tests.world.nets import CITY, generated_map
from tests.world.sumo_traffic.on_sumo import box

PERIOD_MS, TIMEOUT_S = 40, 0.4


def city() -> RoadMap:
    return generated_map(*CITY)


class Beside:
    """A worker that answers when it is told to."""

    def __init__(self, folder: Path) -> None:
        profile = TrafficProfile(period_ms=PERIOD_MS, sumo=SumoProfile(timeout_s=TIMEOUT_S))
        self.port = SumoPort(profile, city(), 100, folder, box(1.0))
        self.memory = SumoMemory.open(folder)
        self.signals = 0

    def answer(self, count: int, letters: str | None = None) -> None:
        if letters is not None:
            self.signals += 1
            now = {one.id: Running(letters * 20, (), 0, FAR) for one in city().signals}
            self.memory.signals.write(self.signals, signals_within(now, signal_bytes(city())))
        values = np.zeros(RECORD_WIDTH + 1)
        values[:RECORD_WIDTH] = to_record(np.ones((count, FIELDS)))
        values[ERROR_AT] = 0.5
        self.memory.answered.write(values, self.memory.asked.newest, self.signals)

    def begin(self) -> None:
        self.answer(3, "r")
        self.memory.say(How.RUNS)
        self.port.wait(lambda: True)


@pytest.fixture
def beside(tmp_path: Path) -> Beside:
    return Beside(tmp_path)


def test_a_step_brings_the_newest_answer_and_asks_for_the_next(beside: Beside) -> None:
    beside.begin()
    assert len(beside.port.road_users()) == 3
    assert beside.memory.asked.newest == 1
    assert len(beside.port.step(box(2.0))) == 3, "not answered yet: those of before"
    assert [record.values[0] for record in beside.memory.asked.since(0)] == [1.0, 2.0]
    beside.answer(5, "G")
    assert len(beside.port.step(box(3.0))) == 5
    assert beside.port.ego_error_m == 0.5
    assert {one.letters[0] for one in beside.port.signals.now.values()} == {"G"}
    assert beside.port.lost is None


def test_who_is_silent_too_long_is_lost_and_asked_no_more(beside: Beside) -> None:
    beside.begin()
    for _ in range(round(1000 * TIMEOUT_S / PERIOD_MS)):
        assert len(beside.port.step(box(2.0))) == 3
    assert len(beside.port.step(box(2.0))) == 0
    assert beside.port.lost == "no answer to 11 steps"
    asked = beside.memory.asked.newest
    beside.answer(4)
    assert len(beside.port.step(box(2.0))) == 0, "it does not come back"
    assert beside.memory.asked.newest == asked


def test_a_worker_that_gives_up_is_lost_at_once(beside: Beside) -> None:
    beside.begin()
    beside.memory.say(How.LOST, "connection closed by SUMO")
    assert len(beside.port.step(box(2.0))) == 0
    assert beside.port.lost == "connection closed by SUMO"


def test_refusal_and_silence_at_the_start_are_errors(beside: Beside) -> None:
    with pytest.raises(ProfileError, match="its worker does not answer"):
        beside.port.wait(lambda: False)
    beside.memory.say(How.REFUSED, "environment.traffic.sumo: SUMO: no such edge")
    with pytest.raises(ProfileError, match=r"environment\.traffic\.sumo: SUMO: no such edge"):
        beside.port.wait(lambda: True)


def test_what_is_missing_is_named_before_a_worker_starts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert importlib.util.find_spec("libsumo") is not None
    monkeypatch.setattr(engines, "find_spec", lambda name: None)
    with pytest.raises(ProfileError, match="libsumo, of the extra `sumo`"):
        Beside(tmp_path)
