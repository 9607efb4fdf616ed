"""A recorded drive that is made up, in the columns of this version: what readers of recordings are tested with."""

from collections.abc import Iterator, Sequence

import numpy as np

from simconsole.profiles.session import SessionProfile
from simconsole.recording.framing import Message, Record
from simconsole.recording.log_header import ACTS, LogHeader, message_stream, vector_stream
from simconsole.recording.reading import Block, LogTable, places
from simconsole.recording.scan import Break
from simconsole.values.layout import write
from simconsole.values.signals import EventInput, RemoteCommand
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT

COLUMNS = tuple(f"{stage}.{field}" for stage, part in LAYOUT._asdict().items() for field in part.names)
SESSION = SessionProfile(schema=1)
TICKS = 1000
BLOCK = 300


class MadeRecording:
    """Blocks of a drive. It offers no table: whoever asks for one does not stream."""

    def __init__(
        self,
        vectors: np.ndarray,
        columns: tuple[str, ...] = COLUMNS,
        tick_hz: int = 250,
        acts: tuple[Message, ...] | None = (),
    ) -> None:
        """`acts` None: recorded by a version that had no stream of them."""
        streams = (vector_stream(columns, 1), *(() if acts is None else (message_stream(ACTS),)))
        self.header = LogHeader(
            tick_hz=tick_hz, streams=streams, console_version="", source_sha256="", session_sha256=""
        )
        self.acts = acts
        self.vectors = vectors
        self.breaks: tuple[Break, ...] = ()
        self.last: Record | None = None
        self.passes = 0

    def __iter__(self) -> Iterator[Record]:
        raise AssertionError("read tick by tick")

    def table(self, columns: Sequence[str] | None = None) -> LogTable:
        raise AssertionError("read as a whole")

    def messages(self, stream: str) -> Iterator[Message]:
        assert stream == ACTS
        assert self.acts is not None
        return iter(self.acts)

    def blocks(self, columns: Sequence[str] | None = None) -> Iterator[Block]:
        self.passes += 1
        at = places(self.header, columns)
        for start in range(0, len(self.vectors), BLOCK):
            part = self.vectors[start : start + BLOCK, at]
            yield Block(np.arange(start + 1, start + 1 + len(part)), part)


def made_vectors(ticks: int = TICKS) -> np.ndarray:
    """Vectors of a car that drives a curve, commanded in every fifth tick."""
    vectors = np.zeros((ticks, PLATFORM_AT))
    for row, tick in zip(vectors, range(1, ticks + 1), strict=True):
        row[LAYOUT.vehicle.at("x_m")] = 0.1 * tick
        row[LAYOUT.vehicle.at("y_m")] = np.sin(0.01 * tick)
        row[LAYOUT.vehicle.at("yaw_rad")] = 0.001 * tick
        row[LAYOUT.vehicle.at("vx_mps")] = 10.0 / 3.0
        row[LAYOUT.arbitration.at("mode")] = 3.0 if tick > 500 else 1.0
        sent = (tick - 1) // 5
        command = RemoteCommand(*(0.0,) * 17)._replace(
            kind=float(sent > 0), sequence=float(sent), age_ticks=float((tick - 1) % 5), accel_mps2=0.1 * sent / 200.0,
            direction=1.0,
        )  # fmt: skip
        write(row, LAYOUT.ros, command)
        write(row, LAYOUT.events, EventInput(float(128 * (tick == 700))))
    return vectors
