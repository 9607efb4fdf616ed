import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from simconsole.recording.bundles.log import LogReader
from simconsole.recording.framing import Record
from simconsole.recording.log_header import LogHeader
from simconsole.recording.replay import first_unequal, replay
from simconsole.values.errors import RecordingError

Advance = Callable[[int, np.ndarray, np.ndarray], np.ndarray]


@pytest.fixture
def log(tmp_path: Path, log_bytes: bytes) -> LogReader:
    (tmp_path / "drive.log").write_bytes(log_bytes)
    return LogReader(tmp_path / "drive.log")


def test_the_same_console_gives_the_same_bytes(log: LogReader, header: LogHeader, toy_advance: Advance) -> None:
    for _ in range(3):
        result = replay(log, header, header.columns, np.zeros(4), toy_advance, first_tick=1)
        assert result.equal
        assert result.ticks == 40
        assert result.difference is None
        assert result.digest == list(log)[-1].digest


def test_a_forged_input_is_found_at_its_tick(
    log: LogReader, header: LogHeader, toy_advance: Advance, rewrite_log: Callable[..., None]
) -> None:
    rewrite_log(log.path, 17, "sample.brake_axis", 0.5)
    result = replay(log, header, header.columns, np.zeros(4), toy_advance)
    assert not result.equal
    assert result.ticks == 16
    assert result.difference is not None
    assert result.difference[:2] == (17, "driver.brake")
    assert result.difference.replayed == 0.25
    assert str(result.difference).startswith("tick 17: driver.brake: recorded ")


def test_a_forged_vehicle_value_is_found_to_the_last_bit(
    log: LogReader, header: LogHeader, toy_advance: Advance, rewrite_log: Callable[..., None]
) -> None:
    true = list(log)[29].vector[3]
    rewrite_log(log.path, 30, "vehicle.vx_mps", math.nextafter(true, math.inf))
    difference = replay(log, header, header.columns, np.zeros(4), toy_advance).difference
    assert difference is not None
    assert difference[:2] == (30, "vehicle.vx_mps")
    assert difference.replayed == true != difference.recorded


def test_a_wrong_hash_alone_is_found(log: LogReader, header: LogHeader, toy_advance: Advance) -> None:
    records = [Record(r.tick, r.vector, bytes(8) if r.tick == 3 else r.digest) for r in log]
    result = replay(records, header, header.columns, np.zeros(4), toy_advance)
    assert not result.equal
    assert str(result.difference) == "tick 3: the state vector is equal, but the recorded hash does not belong to it"


def test_recorded_inputs_are_handed_over_writable(log: LogReader, header: LogHeader, toy_advance: Advance) -> None:
    def strict(tick: int, previous: np.ndarray, inputs: np.ndarray) -> np.ndarray:
        assert inputs.flags.writeable
        assert inputs.shape == (2,)
        return toy_advance(tick, previous, inputs)

    assert replay(log, header, header.columns, np.zeros(4), strict).equal


def test_a_recording_with_other_columns_is_refused(log: LogReader, header: LogHeader, toy_advance: Advance) -> None:
    with pytest.raises(RecordingError, match=r"'driver\.brake' where this version has 'driver\.brakes'"):
        replay(log, header, (*header.columns[:2], "driver.brakes", "vehicle.vx_mps"), np.zeros(4), toy_advance)
    with pytest.raises(RecordingError, match="another number of columns"):
        replay(log, header, header.columns[:3], np.zeros(3), toy_advance)


def test_a_gap_is_refused(log: LogReader, header: LogHeader, toy_advance: Advance) -> None:
    with pytest.raises(RecordingError, match="from tick 5 on"):
        replay((r for r in log if r.tick != 5), header, header.columns, np.zeros(4), toy_advance)
    with pytest.raises(RecordingError, match="from tick 1 on"):
        replay((r for r in log if r.tick > 1), header, header.columns, np.zeros(4), toy_advance, first_tick=1)


def test_a_tick_lost_at_the_end_is_not_an_equal_replay(log: LogReader, header: LogHeader, toy_advance: Advance) -> None:
    content = bytearray(log.path.read_bytes())
    content[-20] ^= 1
    log.path.write_bytes(bytes(content))
    with pytest.raises(RecordingError, match="not whole: 39 of 40 ticks"):
        replay(log, header, header.columns, np.zeros(4), toy_advance, recorded_ticks=40)
    assert replay(log, header, header.columns, np.zeros(4), toy_advance).ticks == 39  # a killed drive says no number


def test_first_unequal_compares_bytes() -> None:
    assert first_unequal(np.array([1.0, math.nan]), np.array([1.0, math.nan])) is None
    assert first_unequal(np.array([1.0, 0.0]), np.array([1.0, -0.0])) == 1
