"""Traces for tests."""

from pathlib import Path

from simconsole.devices.sources.trace_files import TraceWriter
from simconsole.devices.synthetic.trace_format import TraceHeader
from simconsole.values.signals import DeviceSample

HEADER = TraceHeader(250, "test")
REST = DeviceSample(0.0, 1.0, 1.0, 1.0, *(0.0,) * 9)


def written(path: Path, rows: list[DeviceSample], first: int = 1) -> Path:
    with TraceWriter(path, HEADER) as writer:
        for tick, sample in enumerate(rows, start=first):
            writer.write(tick, sample)
    return path
