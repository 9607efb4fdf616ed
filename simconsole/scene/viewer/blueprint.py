"""What the operators see when they open the recording: chase view, map, mode lane, plots, log."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from simconsole.scene.entities import Array, on_map
from simconsole.scene.lanes import CONTROLS, HEALTH, WHO_DRIVES
from simconsole.scene.plots import Plot, plots_of
from simconsole.scene.viewer.standing import MAP

if TYPE_CHECKING:
    import rerun.blueprint as rrb

    from simconsole.scene.viewer.job import Job

TIMELINE: Final = "sim_time"
LOG: Final = "log"
LATENCY: Final = "latency"
CAMERA: Final = "camera"
AHEAD_M: Final = 14.0
DARK: Final = (13, 17, 23)
SKY: Final = (38, 48, 60)


def blueprint(job: Job, path: Array | None, is_live: bool = False) -> rrb.Blueprint:
    """Return the operators' desk: who drives above all, then the vehicle, the map and the plots.

    Args:
        job: the vehicle, and where the camera stands behind it.
        path: [N, 2 or 3] m, what the map shows whole, if anything.
        is_live: time goes on by itself.
    """
    import rerun.blueprint as rrb

    # The height of three lanes and their time axis: none of them is clipped.
    who = rrb.StateTimelineView(name="who drives", origin=f"/{WHO_DRIVES}")
    health = rrb.StateTimelineView(name="health", origin=f"/{HEALTH}")
    log = rrb.TextLogView(name="log", origin=f"/{LOG}")
    controls = rrb.StateTimelineView(name="controls", origin=f"/{CONTROLS}")
    latency = rrb.TextDocumentView(name="latency", origin=f"/{LATENCY}")
    camera = rrb.Spatial2DView(name="camera", origin=f"/{CAMERA}")
    is_robot = job.vehicle.is_robot
    beside = rrb.Tabs(log, *(() if is_robot else (controls,)), latency, active_tab="log")
    left = rrb.Vertical(who, _chase(job), rrb.Horizontal(health, beside), row_shares=[2.0, 4.6, 3.4])
    lines = [_plot_view(plot) for plot in plots_of(is_robot)]
    half = (len(lines) + 1) // 2
    columns = rrb.Horizontal(rrb.Vertical(*lines[:half]), rrb.Vertical(*lines[half:]))
    above = rrb.Horizontal(_plan(path), camera) if job.has_camera else _plan(path)
    right = rrb.Vertical(above, columns, row_shares=[3, 7])
    return rrb.Blueprint(
        rrb.Horizontal(left, right, column_shares=[9, 11]),
        rrb.TimePanel(state="collapsed", timeline=TIMELINE, play_state="following" if is_live else None),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
        auto_views=False,
    )


def _so_far() -> rrb.VisibleTimeRanges:
    import rerun.blueprint as rrb

    return rrb.VisibleTimeRanges(
        timeline=TIMELINE,
        start=rrb.TimeRangeBoundary.infinite(),
        end=rrb.TimeRangeBoundary.cursor_relative(),
    )


def _chase(job: Job) -> rrb.Spatial3DView:
    import rerun.blueprint as rrb

    profile, scale = job.profile, job.dimensions.scale
    return rrb.Spatial3DView(
        name="chase",
        origin="/world/ego",
        contents="/world/**",
        background=SKY,
        line_grid=rrb.LineGrid3D(visible=False),
        # The origin moves with the car and turns with it, so a camera that stands still follows.
        eye_controls=rrb.EyeControls3D(
            position=(-scale * profile.chase_back_m, 0.0, scale * profile.chase_up_m),
            look_target=(scale * AHEAD_M, 0.0, 0.0),
            eye_up=(0, 0, 1),
        ),
        overrides={"world/path/driven": _so_far()},
    )


def _plan(path: Array | None) -> rrb.Spatial2DView:
    import rerun.blueprint as rrb

    return rrb.Spatial2DView(
        name="map",
        origin=f"/{MAP}",
        background=DARK,
        visual_bounds=None if path is None else _bounds(on_map(path)),
        overrides={f"{MAP}/path/driven": _so_far()},
    )


def _plot_view(plot: Plot) -> rrb.TimeSeriesView:
    import rerun.blueprint as rrb

    return rrb.TimeSeriesView(
        name=plot.title,
        origin=f"/{plot.path}",
        axis_y=None if plot.low is None or plot.high is None else rrb.ScalarAxis(range=(plot.low, plot.high)),
        plot_legend=rrb.PlotLegend(rrb.Corner2D.LeftTop, visible=len(plot.series) > 1),
    )


def _bounds(points: Array) -> rrb.VisualBounds2D:
    import rerun.blueprint as rrb

    low, high = points.min(axis=0), points.max(axis=0)
    margin = 0.06 * float((high - low).max())
    return rrb.VisualBounds2D(
        x_range=(low[0] - margin, high[0] + margin),
        y_range=(low[1] - margin, high[1] + margin),
    )
