"""A finished drive from Python: its columns, metrics, events and plots."""

from collections.abc import Callable, Iterator
from fnmatch import fnmatchcase
from functools import cached_property
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.evaluation.metrics import table
from simconsole.evaluation.metrics.drive_metrics import ModeChange, metrics, mode_changes
from simconsole.evaluation.metrics.track import Track, track
from simconsole.profiles.faults import fault_label
from simconsole.recording.bundles.bundle import Bundle, open_bundle
from simconsole.recording.bundles.replay_bundle import recorded_session, replay_bundle
from simconsole.recording.own_signals import with_own_signals
from simconsole.recording.replay import ReplayResult
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.errors import RecordingError
from simconsole.values.labels import mode_label, reason_label
from simconsole.values.signals import Event
from simconsole.world.kinds.worlds import open_world
from simconsole.world.route import Route

if TYPE_CHECKING:
    import pandas
    import polars
    from matplotlib.figure import Figure

Array = NDArray[np.float64]

_MAP_INCH, _TRACES_INCH = (9.2, 7.4), (9.2, 7.6)


class DriveEvent(NamedTuple):
    """One thing that happened: what (`Event` in lower case, or `mode`), when, and for a mode which one and why."""

    tick: int
    t_s: float
    name: str
    detail: str = ""


class Drive:
    """A recorded drive. What is asked for is read then; a long one never lies in memory whole.

    Attributes:
        folder: of its bundle.
        ticks: how many it has.
        tick_hz: ticks per simulated second.
        columns: names of all columns, `stage.field_unit`; own signals are called `own.NAME`.
    """

    def __init__(self, folder: str | Path) -> None:
        """Open a bundle.

        Raises:
            RecordingError: not a bundle, or empty.
        """
        self.folder = Path(folder)
        self._bundle: Bundle = open_bundle(self.folder)
        self._recording = with_own_signals(self._bundle.log)
        self._drive = table.recorded_drive(self._recording)
        self.ticks, self.tick_hz = self._drive.ticks, self._drive.tick_hz
        self.columns: tuple[str, ...] = self._recording.header.columns

    def __repr__(self) -> str:
        return f"Drive({str(self.folder)!r}, {self.ticks} ticks, {self.ticks / self.tick_hz:g} s)"

    @property
    def digest(self) -> str:
        """The chained hash of its state vectors: equal for equal drives."""
        return self._bundle.manifest.digest

    @cached_property
    def session(self) -> ResolvedSession:
        """The session as it was driven, every profile in full."""
        return recorded_session(self._bundle)

    @property
    def time_s(self) -> Array:
        """Simulated time of every tick in s, float64 [ticks]."""
        return self._drive.time_s

    def column(self, name: str) -> Array:
        """Return one column, float64 [ticks], in the unit of its name.

        Raises:
            RecordingError: the drive has no such column.
        """
        return self._drive.column(self._chosen((name,))[0])

    def arrays(self, *patterns: str) -> dict[str, Array]:
        """Return the columns that fit names or patterns (`vehicle.*`), float64 [ticks] each; all without any.

        Raises:
            RecordingError: a pattern that fits no column.
        """
        names = self._chosen(patterns or ("*",))
        return dict(zip(names, self._drive.columns(*names), strict=True))

    def pandas(self, *patterns: str) -> "pandas.DataFrame":
        """Return the columns that fit as a frame of pandas, its index the simulated time in s.

        Raises:
            RecordingError: a pattern that fits no column.
            ImportError: pandas is not installed (extra `pandas`).
        """
        import pandas

        return pandas.DataFrame(self.arrays(*patterns), index=pandas.Index(self.time_s, name="time_s"))

    def polars(self, *patterns: str) -> "polars.DataFrame":
        """Return the columns that fit as a frame of polars, `time_s` its first one.

        Raises:
            RecordingError: a pattern that fits no column.
            ImportError: polars is not installed (extra `polars`).
        """
        import polars

        return polars.DataFrame({"time_s": self.time_s, **self.arrays(*patterns)})

    def _chosen(self, patterns: tuple[str, ...]) -> tuple[str, ...]:
        for pattern in patterns:
            if not any(fnmatchcase(name, pattern) for name in self.columns):
                stages = dict.fromkeys(name.partition(".")[0] for name in self.columns)
                raise RecordingError(f"{self.folder}: column: value {pattern!r}: fits no column of {', '.join(stages)}")
        return tuple(name for name in self.columns if any(fnmatchcase(name, pattern) for pattern in patterns))

    @cached_property
    def metrics(self) -> dict[str, Any]:
        """What the report says, as plain values with the unit in every key; None where the drive has no such part."""
        faults = [fault_label(fault) for fault in self.session.session.scenario.faults]
        return metrics(table.read_at_once(self._recording, self.ticks), self._route, faults=faults)

    @property
    def events(self) -> list[DriveEvent]:
        """What happened, in order: every edge of `Event`, every change of mode and every refusal."""
        found = [
            DriveEvent(
                tick=change.tick,
                t_s=change.t_s,
                name="refused" if change.refused else "mode",
                detail=f"{mode_label(change.mode)} ({reason_label(change.reason)})",
            )
            for change in self._changes
        ]
        return sorted((*found, *self._edges()), key=lambda event: event.tick)

    def _edges(self) -> Iterator[DriveEvent]:
        start = self._drive.first_tick
        for block in self._drive.read(("events.events",)):
            masks = block[:, 0].astype(np.int64)
            for at in np.flatnonzero(masks).tolist():
                for event in Event(int(masks[at])):
                    tick = start + at
                    yield DriveEvent(tick, tick / self.tick_hz, (event.name or "").lower())
            start += len(block)

    def plot(self) -> "Figure":
        """Return lateral deviation, speed, steering and mode over the distance driven, as a figure of matplotlib."""
        from simconsole.evaluation.report.figure_traces import draw_traces

        return self._figure(_TRACES_INCH, draw_traces)

    def plot_map(self) -> "Figure":
        """Return the driven path over the theoretical one, as a figure of matplotlib."""
        from simconsole.evaluation.report.figure_map import draw_map

        return self._figure(_MAP_INCH, draw_map)

    def _figure(self, size_inch: tuple[float, float], draw: Callable[..., None]) -> "Figure":
        from simconsole.evaluation.report.figures import figure

        drawn: Figure = figure(size_inch, lambda made: draw(made, self._drive, self._track, self._changes, self._route))
        return drawn

    def replay(self) -> ReplayResult:
        """Make every tick again from its recorded inputs, and say where the result differs.

        Raises:
            RecordingError: truncated, or with a gap.
        """
        return replay_bundle(self.folder)

    @cached_property
    def _route(self) -> Route | None:
        return None if self.session.world is None else open_world(self.session.world).route

    @cached_property
    def _track(self) -> Track:
        return track(self._drive, self._route)

    @cached_property
    def _changes(self) -> list[ModeChange]:
        return mode_changes(self._drive, self._track)

    def _repr_html_(self) -> str:
        """Show it in a notebook."""
        shown = ("duration_s", "distance_m", "mean_speed_kmh", "max_speed_kmh", "max_lateral_accel_mps2")
        rows = "".join(f"<tr><th>{escape(key)}</th><td>{self.metrics[key]:.6g}</td></tr>" for key in shown)
        return f"<table><caption>{escape(repr(self))}</caption>{rows}</table>"


def open_drive(folder: str | Path) -> Drive:
    """Return the recorded drive in the bundle `folder`, in whatever form it is.

    Raises:
        RecordingError: not a bundle, or empty.
    """
    return Drive(folder)
