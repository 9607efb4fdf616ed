"""Plots of a test manoeuvre: one panel beside the other."""

from typing import Any, Final

from simconsole.evaluation.manoeuvres.attempt import Panel
from simconsole.evaluation.report.colours import END, LIMIT, NOTE, PERSON, REMOTE, START

_COLOURS: Final = (REMOTE, PERSON, START, END, NOTE)
_ROW: Final = 2


def draw_panels(figure: Any, panels: tuple[Panel, ...]) -> None:
    """Draw the panels into a matplotlib figure; a line without a name is grey where others have one."""
    rows = -(-len(panels) // _ROW)
    grid = figure.subplots(rows, min(_ROW, len(panels)), squeeze=False)
    for axes, panel in zip(grid.flat, panels, strict=False):
        axes.set_title(panel.title)
        axes.set_xlabel(panel.x_label)
        axes.set_ylabel(panel.y_label)
        named = any(line.label for line in panel.lines)
        colours = iter(_COLOURS)
        for line in panel.lines:
            plain = named and not line.label
            axes.plot(
                line.x,
                line.y,
                color=LIMIT if plain else next(colours, NOTE),
                linewidth=1.0 if plain else 1.3,
                label=line.label or None,
            )
        if named:
            axes.legend(loc="best")
    for axes in grid.flat[len(panels) :]:
        axes.set_visible(False)
