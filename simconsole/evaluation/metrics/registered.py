"""Metrics of other packages: found by the entry points `simconsole.metrics`, their figures named and inside bounds.

They stand among ours as `own.NAME.FIGURE_unit`: in the report, in `Drive.metrics`, in a scenario's `metrics:` and in
the columns of a sweep. Pure: a metric is called with a drive and returns figures.
"""

import math
from collections.abc import Callable, Mapping
from typing import Final, NamedTuple

from simconsole.evaluation.metrics.table import Drive
from simconsole.evaluation.metrics.track import Track
from simconsole.values.errors import MetricError, SimConsoleError, one_line
from simconsole.values.registered import found, load
from simconsole.world.route import Route

GROUP: Final = "simconsole.metrics"


class Figure(NamedTuple):
    """What a figure says, and between which values it can be."""

    title: str
    lowest: float = -math.inf
    highest: float = math.inf


class Driven(NamedTuple):
    """What a metric looks at."""

    drive: Drive  # its columns, as of `drive.columns(...)` or, for long ones, `drive.read(...)`
    track: Track  # place on the route, lateral deviation, speed and who drove, of each tick
    route: Route | None  # None: a world without one


class OwnMetric(NamedTuple):
    """What an entry point names: figures by name, the unit at its end, and the function that returns them.

    A figure that a drive does not have is left out, or None. Equal drives must give equal figures.
    """

    figures: Mapping[str, Figure]
    measure: Callable[[Driven], Mapping[str, float | None]]


def registered() -> dict[str, OwnMetric]:
    """Return the metrics that packages have registered, by name.

    Raises:
        ProfileError: one cannot be loaded, or is no `OwnMetric`.
    """
    return {name: load(GROUP, name, OwnMetric, GROUP) for name in found(GROUP)}


def own_metrics(driven: Driven, metrics: Mapping[str, OwnMetric] | None = None) -> dict[str, dict[str, float | None]]:
    """Return the figures of the registered metrics, or of `metrics`, by the names of both; of each all of its figures.

    Raises:
        ProfileError: one cannot be loaded.
        MetricError: one fails, or returns what it does not promise.
    """
    chosen = registered() if metrics is None else metrics
    return {name: measured(name, metric, driven) for name, metric in chosen.items()}


def measured(name: str, metric: OwnMetric, driven: Driven) -> dict[str, float | None]:
    """Return all figures of one metric, None where the drive has none.

    Raises:
        MetricError: it fails, or returns a figure that it does not promise, that is not finite or out of its bounds.
    """
    try:
        given = dict(metric.measure(driven))
        values = {key: None if value is None else float(value) for key, value in given.items()}
    except SimConsoleError:
        raise
    except Exception as error:  # whatever a stranger's function does
        raise MetricError(f"metric {name}: {one_line(error)}") from error
    for key, value in values.items():
        if key not in metric.figures:
            raise MetricError(f"metric {name}: {key}: one of {', '.join(metric.figures) or 'none'}")
        bounds = metric.figures[key]
        if value is not None and not (math.isfinite(value) and bounds.lowest <= value <= bounds.highest):
            raise MetricError(
                f"metric {name}: {key}: value {value:g}: a finite number, {bounds.lowest:g} to {bounds.highest:g}"
            )
    return {key: values.get(key) for key in metric.figures}
