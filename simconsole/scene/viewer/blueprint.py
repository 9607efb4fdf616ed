"""What the operators see when they open the recording: chase view, map, mode lane, plots, log."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from simconsole.profiles.view import SceneProfile
from simconsole.scene.entities import Array, on_map
from simconsole.scene.timeline import PLOTS

if TYPE_CHECKING:
    import rerun.blueprint as rrb

TIMELINE: Final = "sim_time"
MAP: Final = "map"
"""Root of the flat copies: a picture's y axis points down, the map's up, so they have coordinates of their own."""
AHEAD_M: Final = 14.0
DARK: Final = (13, 17, 23)
SKY: Final = (38, 48, 60)


def blueprint(profile: SceneProfile, scale: float, path: Array | None) -> rrb.Blueprint:
    """Return the operators' screen.

    Args:
        profile: where the camera stands behind a car.
        scale: size of the vehicle against a car's.
        path: [N, 2 or 3] m, what the map shows whole, if anything.
    """
    import rerun.blueprint as rrb

    so_far = rrb.VisibleTimeRanges(
        timeline=TIMELINE,
        start=rrb.TimeRangeBoundary.infinite(),
        end=rrb.TimeRangeBoundary.cursor_relative(),
    )
    chase = rrb.Spatial3DView(
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
        overrides={"world/path/driven": so_far},
    )
    plan = rrb.Spatial2DView(
        name="map",
        origin=f"/{MAP}",
        background=DARK,
        visual_bounds=None if path is None else _bounds(on_map(path)),
        overrides={f"{MAP}/path/driven": so_far},
    )
    lanes = rrb.StateTimelineView(name="who drives", origin="/lanes")
    log = rrb.TextLogView(name="log", origin="/log")
    plots = [
        rrb.TimeSeriesView(
            name=plot.title,
            origin=f"/{plot.path}",
            axis_y=None if plot.low is None or plot.high is None else rrb.ScalarAxis(range=(plot.low, plot.high)),
            plot_legend=rrb.PlotLegend(rrb.Corner2D.RightTop, visible=len(plot.series) > 1),
        )
        for plot in PLOTS
    ]
    left = rrb.Vertical(chase, lanes, log, row_shares=[5, 1.6, 1.6])
    right = rrb.Vertical(plan, *plots, row_shares=[4, *[1.4] * len(plots)])
    return rrb.Blueprint(
        rrb.Horizontal(left, right, column_shares=[3, 2]),
        rrb.TimePanel(state="collapsed", timeline=TIMELINE),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
        auto_views=False,
    )


def _bounds(points: Array) -> rrb.VisualBounds2D:
    import rerun.blueprint as rrb

    low, high = points.min(axis=0), points.max(axis=0)
    margin = 0.06 * float((high - low).max())
    return rrb.VisualBounds2D(
        x_range=(low[0] - margin, high[0] + margin),
        y_range=(low[1] - margin, high[1] + margin),
    )
