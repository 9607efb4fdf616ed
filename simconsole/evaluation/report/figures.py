"""The pictures of a report, as SVG text that is the same for the same drive, byte for byte (matplotlib, on demand)."""

import io
from collections.abc import Callable, Sequence
from typing import Any, Final

from simconsole.evaluation.manoeuvres.attempt import Panel
from simconsole.evaluation.metrics.drive_metrics import ModeChange
from simconsole.evaluation.metrics.table import Array, Drive
from simconsole.evaluation.metrics.track import Track
from simconsole.evaluation.report.figure_map import draw_map
from simconsole.evaluation.report.figure_panels import draw_panels
from simconsole.evaluation.report.figure_traces import draw_traces
from simconsole.evaluation.report.figure_words import panels_words
from simconsole.evaluation.report.frame import picture
from simconsole.values.host.loading import loaded
from simconsole.world.route import Route

STYLE: Final[Any] = {
    "font.family": "DejaVu Sans",  # ships with matplotlib, so the same everywhere
    "font.size": 9.0,
    "axes.titlesize": 10.0,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.edgecolor": "#9aa0a6",
    "axes.labelcolor": "#3c4043",
    "axes.linewidth": 0.8,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "grid.color": "#e8eaed",
    "grid.linewidth": 0.7,
    "legend.frameon": False,
    "legend.fontsize": 8.5,
    "path.simplify": True,
    "svg.fonttype": "path",
    "text.color": "#202124",
    "xtick.color": "#5f6368",
    "ytick.color": "#5f6368",
}


def map_svg(
    drive: Drive, way: Track, changes: list[ModeChange], route: Route | None, walls: Sequence[Array] = ()
) -> str:
    """Return the driven path over the theoretical one, start green and end red (the paper's Fig. 9)."""
    return _svg("map", (9.2, 7.4), lambda figure: draw_map(figure, drive, way, changes, route, walls))


def traces_svg(drive: Drive, way: Track, changes: list[ModeChange], route: Route | None, *, robot: bool = False) -> str:
    """Return lateral deviation, speed and steering over the distance driven, with the mode beneath."""
    size = 9.2, 6.0 if robot else 9.2
    return _svg("traces", size, lambda figure: draw_traces(figure, drive, way, changes, route, robot=robot))


def panels_svg(name: str, panels: tuple[Panel, ...]) -> str:
    """Return the plots of a test manoeuvre, two beside each other."""
    rows = -(-len(panels) // 2)
    return _svg(name, (9.2, 2.9 * rows), lambda figure: draw_panels(figure, panels))


def panels_picture(name: str, title: str, panels: tuple[Panel, ...]) -> str:
    """Return them as a figure of a page, with a name and in words what they show."""
    return picture(panels_svg(name, panels), title, panels_words(panels))


def figure(size_inch: tuple[float, float], draw: Callable[[Any], None]) -> Any:
    """Return a figure of matplotlib in the style of the reports; `draw` puts the axes in. Notebooks show it as SVG."""
    loaded("matplotlib.backends.backend_svg")
    from matplotlib import rc_context
    from matplotlib.backends.backend_svg import FigureCanvasSVG
    from matplotlib.figure import Figure

    class Shown(Figure):
        def _repr_svg_(self) -> str:
            text = io.StringIO()
            self.savefig(text, format="svg")
            return text.getvalue()

    with rc_context(STYLE):
        made = Shown(figsize=size_inch, layout="constrained")
        FigureCanvasSVG(made)
        draw(made)
    return made


def _svg(name: str, size_inch: tuple[float, float], draw: Callable[[Any], None]) -> str:
    loaded("matplotlib.backends.backend_svg")
    from matplotlib import rc_context

    # The salt makes the identifiers inside equal in every run, and different between the figures of one page.
    settings: Any = {**STYLE, "svg.hashsalt": f"simconsole {name}"}
    text = io.StringIO()
    with rc_context(settings):
        figure(size_inch, draw).savefig(text, format="svg", metadata={"Date": None, "Creator": None})
    svg = text.getvalue()
    return svg[svg.index("<svg") :]
