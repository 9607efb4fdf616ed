import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from simconsole.recording.bundles.log import LogReader
from simconsole.recording.framing import Record
from simconsole.recording.log_header import LogHeader
from simconsole.recording.replay import Remade, replay
from simconsole.values.errors import RecordingError

Advance = Callable[[int, np.ndarray, np.ndarray], np.ndarray]


@pytest.fixture
def log(tmp_path: Path, log_bytes: bytes) -> LogReader:
    (tmp_path / "drive.log").write_bytes(log_bytes)
    return LogReader(tmp_path / "drive.log")


@pytest.fixture
def toy(header: LogHeader, toy_advance: Advance) -> Remade:
    return Remade(header.columns, np.array([0.125, 0.25]), np.zeros(4), toy_advance)


def test_the_same_console_gives_the_same_bytes(log: LogReader, toy: Remade) -> None:
    for _ in range(3):
        result = replay(log, log.header, toy, first_tick=1)
        assert (result.good, result.equal, result.hashes_equal, result.ticks) == (True, True, True, 40)
        assert (result.differences, result.new, result.missing, result.problems) == ((), (), (), ())
        assert result.digest == list(log)[-1].digest


def test_a_forged_input_is_found_at_its_tick_and_followed_to_the_end(
    log: LogReader, toy: Remade, rewrite_log: Callable[..., None]
) -> None:
    before = list(log)[16].vector
    rewrite_log(log.path, 17, "sample.brake_axis", 0.5)
    result = replay(log, log.header, toy)
    assert (result.equal, result.hashes_equal, result.ticks) == (False, False, 40)
    brake, speed = result.differences
    assert (brake.field, brake.first_tick, brake.ticks) == ("driver.brake", 17, 1)
    assert brake.values == (before[2], 0.25)
    assert brake.largest == abs(before[2] - 0.25)
    assert [tick for tick, _, _ in brake.around] == list(range(14, 21))
    assert (speed.field, speed.unit, speed.first_tick, speed.ticks) == ("vehicle.vx_mps", "m/s", 17, 24)
    assert speed.largest_tick == 17, "what was lost or won fades from there on"


def test_a_forged_vehicle_value_is_found_to_the_last_bit(
    log: LogReader, toy: Remade, rewrite_log: Callable[..., None]
) -> None:
    true = list(log)[29].vector[3]
    forged = math.nextafter(true, math.inf)
    rewrite_log(log.path, 30, "vehicle.vx_mps", forged)
    result = replay(log, log.header, toy)
    (difference,) = result.differences
    assert (difference.field, difference.first_tick, difference.ticks) == ("vehicle.vx_mps", 30, 1)
    assert difference.values == (forged, true)
    within = replay(log, log.header, toy, tolerances={"vehicle.*": 1e-9})
    assert (within.good, within.hashes_equal) == (True, False)


def test_a_wrong_hash_alone_is_found(log: LogReader, toy: Remade) -> None:
    records = [Record(r.tick, r.vector, bytes(8) if r.tick == 3 else r.digest) for r in log]
    result = replay(records, log.header, toy)
    assert (result.good, result.hashes_equal, result.differences) == (False, False, ())
    assert result.problems == ("stream state: the chained hash does not hold at tick 3",)


def test_recorded_inputs_are_handed_over_writable(log: LogReader, toy: Remade) -> None:
    def strict(tick: int, previous: np.ndarray, inputs: np.ndarray) -> np.ndarray:
        assert inputs.flags.writeable
        assert inputs.shape == (2,)
        return toy.advance(tick, previous, inputs)

    assert replay(log, log.header, toy._replace(advance=strict)).equal


def newer(advance: Advance) -> Advance:
    """The toy console of a later version: a clutch, which opens nothing while it is 0.25, and a gear."""

    def step(tick: int, previous: np.ndarray, inputs: np.ndarray) -> np.ndarray:
        clutch, throttle, brake = inputs
        row = advance(tick, np.array([0.0, 0.0, 0.0, previous[5]]), np.array([brake, throttle]))
        return np.array([clutch, throttle, brake, row[2], 1.0, row[3] + (clutch - 0.25)])

    return step


NEWER = ("sample.clutch_axis", "sample.throttle_axis", "sample.brake_axis", "driver.brake", "vehicle.gear",
         "vehicle.vx_mps")  # fmt: skip


def test_inputs_go_by_name_and_new_ones_have_their_default(log: LogReader, toy_advance: Advance) -> None:
    version = Remade(NEWER, np.array([0.25, 0.0, 0.0]), np.zeros(6), newer(toy_advance))
    result = replay(log, log.header, version, first_tick=1, recorded_ticks=40)
    assert (result.good, result.hashes_equal, result.ticks) == (True, False, 40)
    assert (result.new, result.missing) == (("sample.clutch_axis", "vehicle.gear"), ())
    moved = replay(log, log.header, version._replace(no_inputs=np.array([0.5, 0.0, 0.0])))
    assert [one.field for one in moved.differences] == ["vehicle.vx_mps"]
    assert moved.differences[0].first_tick == 1


def test_columns_that_this_version_lacks_are_named(log: LogReader, toy_advance: Advance) -> None:
    def without_brake(tick: int, previous: np.ndarray, inputs: np.ndarray) -> np.ndarray:
        row = toy_advance(tick, np.array([0.0, 0.0, 0.0, previous[2]]), inputs)
        return row[[0, 1, 3]]

    columns = (*log.header.columns[:2], "vehicle.vx_mps")
    result = replay(log, log.header, Remade(columns, np.zeros(2), np.zeros(3), without_brake))
    assert (result.good, result.missing, result.new) == (True, ("driver.brake",), ())


def test_a_renamed_input_is_found_by_its_earlier_name(log: LogReader, toy: Remade) -> None:
    columns = ("sample.brake_pedal", *log.header.columns[1:3], "vehicle.speed_mps")
    names = {"sample.brake_axis": "sample.brake_pedal", "vehicle.vx_mps": "vehicle.speed_mps"}
    version = toy._replace(columns=columns)
    result = replay(log, log.header, version, names=names)
    assert (result.good, result.hashes_equal, result.new, result.missing) == (True, True, (), ())
    unnamed = replay(log, log.header, version)
    assert (unnamed.equal, unnamed.new) == (False, ("sample.brake_pedal", "vehicle.speed_mps"))
    assert unnamed.missing == ("sample.brake_axis", "vehicle.vx_mps")


def test_a_gap_is_refused(log: LogReader, toy: Remade) -> None:
    with pytest.raises(RecordingError, match="from tick 5 on"):
        replay((r for r in log if r.tick != 5), log.header, toy)
    with pytest.raises(RecordingError, match="from tick 1 on"):
        replay((r for r in log if r.tick > 1), log.header, toy, first_tick=1)


def test_a_tick_lost_at_the_end_is_not_an_equal_replay(log: LogReader, toy: Remade) -> None:
    content = bytearray(log.path.read_bytes())
    content[-20] ^= 1
    log.path.write_bytes(bytes(content))
    with pytest.raises(RecordingError, match="not whole: 39 of 40 ticks"):
        replay(log, log.header, toy, recorded_ticks=40)
    assert replay(log, log.header, toy).ticks == 39  # a killed drive says no number
