"""Figures to draw on without a file, and what lies on them."""

from typing import Any


def blank() -> Any:
    """Return a figure that nothing has been drawn on."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure()
    FigureCanvasAgg(figure)
    return figure


def lines(axes: Any, label: str) -> list[Any]:
    """Return the lines of a label."""
    return [line for line in axes.get_lines() if line.get_label() == label]


def words(axes: Any) -> set[str]:
    """Return the texts on axes, but those of the legend."""
    return {text.get_text() for text in axes.texts}
