"""Traces in files: never more than a few lines in memory, and one line about what cannot be opened."""

import tracemalloc
from pathlib import Path

import pytest

from simconsole.devices.sources.trace_files import TraceSource, TraceWriter
from simconsole.values.errors import DeviceError, ProfileError
from tests.devices.traces import HEADER, REST, written


@pytest.mark.fault("F06")
def test_long_trace_is_read_in_constant_memory(tmp_path: Path) -> None:
    """F06: of a file of several MB never more than a few lines are in memory."""
    path = written(tmp_path / "trace.csv", [REST] * 40_000)
    assert path.stat().st_size > 2_000_000
    first = TraceSource(path, tick_hz=250)  # what is made once and kept is no part of it
    first.poll(1)
    first.close()
    tracemalloc.start()
    source = TraceSource(path, tick_hz=250)
    for tick in range(1, 1000):
        source.poll(tick)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    source.close()
    assert peak < 200_000


def test_missing_trace_and_unwritable_trace_are_one_line(tmp_path: Path) -> None:
    with pytest.raises(ProfileError, match="a trace that can be read"):
        TraceSource(tmp_path / "none.csv", tick_hz=250)
    with pytest.raises(DeviceError, match="a file that can be written"):
        TraceWriter(tmp_path / "no" / "folder.csv", HEADER)
