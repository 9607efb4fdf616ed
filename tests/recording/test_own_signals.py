"""Own signals as columns: in the row of the tick that was seen, held until said anew, across blocks and forms."""

from pathlib import Path

import numpy as np
import pytest

from simconsole.recording.bundles.log import LogReader, LogWriter
from simconsole.recording.log_header import ACTS, LogHeader, message_stream, vector_stream
from simconsole.recording.own_signals import own_stream, stream_of, with_own_signals
from simconsole.recording.reading import BLOCK_TICKS
from simconsole.values.errors import RecordingError
from simconsole.values.own_signals import OWN, OwnSignals

SIGNALS = OwnSignals("error_m", "gain")


def header(*others: OwnSignals) -> LogHeader:
    return LogHeader(
        tick_hz=250,
        streams=(vector_stream(("vehicle.x_m", "vehicle.vx_mps"), 0), message_stream(ACTS), *map(stream_of, others)),
        console_version="",
        source_sha256="",
        session_sha256="",
    )


def log(path: Path, ticks: int, said: dict[int, tuple[float, float]]) -> LogReader:
    """A log whose frame N holds x = N, and what was said on seeing tick N - 1."""
    signals = OwnSignals(*SIGNALS.names)
    with LogWriter(path, header(SIGNALS)) as writer:
        for tick in range(1, ticks + 1):
            if tick - 1 in said:
                signals.set(error_m=said[tick - 1][0], gain=said[tick - 1][1])
            writer.append(tick, np.array([tick, 0.5]), signals.take_messages(tick))
    return LogReader(path)


def test_columns_stand_behind_those_of_a_tick_with_their_units(tmp_path: Path) -> None:
    recording = with_own_signals(log(tmp_path / "log", 3, {}))
    assert recording.header.columns == ("vehicle.x_m", "vehicle.vx_mps", "own.error_m", "own.gain")
    assert recording.header.streams[0].units == ("m", "m/s", "m", "1")
    assert np.isnan(recording.table(["own.gain"]).vectors).all()


def test_a_value_stands_in_the_row_of_the_tick_that_was_seen_and_stays(tmp_path: Path) -> None:
    recording = with_own_signals(log(tmp_path / "log", 9, {2: (0.25, 1.0), 6: (-0.5, 2.0)}))
    table = recording.table(["own.gain", "vehicle.x_m", "own.error_m"])
    assert table.column("vehicle.x_m").tolist() == list(range(1, 10))
    assert table.column("own.gain")[1:].tolist() == [1.0] * 4 + [2.0] * 4
    assert table.column("own.error_m")[1:].tolist() == [0.25] * 4 + [-0.5] * 4
    assert np.isnan(table.vectors[0]).tolist() == [True, False, True]


def test_values_are_held_across_blocks(tmp_path: Path) -> None:
    """Said at a block's last tick, the message lies in the next block's first frame."""
    ticks = 2 * BLOCK_TICKS + 10
    recording = with_own_signals(
        log(tmp_path / "log", ticks, {BLOCK_TICKS: (1.0, 1.0), 2 * BLOCK_TICKS + 1: (2.0, 2.0)})
    )
    gain = recording.table(["own.gain"]).column("own.gain")
    assert np.isnan(gain[: BLOCK_TICKS - 1]).all()
    assert (gain[BLOCK_TICKS - 1 : 2 * BLOCK_TICKS] == 1.0).all()
    assert (gain[2 * BLOCK_TICKS :] == 2.0).all()


def test_records_and_other_columns_are_as_recorded(tmp_path: Path) -> None:
    plain = log(tmp_path / "log", 5, {1: (1.0, 1.0)})
    wide = with_own_signals(plain)
    assert [record.digest for record in wide] == [record.digest for record in plain]
    assert wide.last is not None
    assert len(list(wide.messages(OWN))) == 1
    assert wide.table(["vehicle.x_m"]).vectors.tolist() == plain.table(["vehicle.x_m"]).vectors.tolist()
    with pytest.raises(RecordingError, match=r"no column 'own\.gian'"):
        wide.table(["own.gian"])


def test_a_recording_without_is_itself(tmp_path: Path) -> None:
    with LogWriter(tmp_path / "log", header()):
        pass
    plain = LogReader(tmp_path / "log")
    assert own_stream(plain.header) is None
    assert with_own_signals(plain) is plain


def test_a_message_of_another_width_is_told_with_its_tick(tmp_path: Path) -> None:
    with LogWriter(tmp_path / "log", header(SIGNALS)) as writer:
        writer.append(1, np.zeros(2))
        writer.append(2, np.zeros(2), [(OWN, b"12345678")])
    with pytest.raises(RecordingError, match="tick 2: own signals: 8 bytes"):
        with_own_signals(LogReader(tmp_path / "log")).table(["own.gain"])
