"""A file of parameter values for another OpenSCENARIO file: the sets of values that it stands for."""

import math
from collections.abc import Iterator
from itertools import product
from typing import Final

from simconsole.evaluation.openscenario.reading import MOST_TOLD, Source, parts_of
from simconsole.values.errors import ProfileError
from simconsole.world.sumo.xml_guard import Element

VALUES: Final = "ParameterValueDistribution"
MOST_SETS: Final = 1000
_SINGLE: Final = "DeterministicSingleParameterDistribution"
_MULTI: Final = "DeterministicMultiParameterDistribution"
_NEAR: Final = 1e-9
"""Share of a step by which the last value of a range may lie above its limit: limits are rounded, too."""

ValueSet = dict[str, str]
"""Values of parameters by name."""


def value_sets(content: bytes, origin: str) -> list[ValueSet]:
    """Return every combination of what a <ParameterValueDistribution> lists, in the order of the file.

    The scenario that it names is not looked for.

    Raises:
        ProfileError: it is no such file, cannot be read, draws its values, or has more than MOST_SETS sets; names the
            element with its line.
    """
    source, parts = Source(origin), parts_of(content, origin)
    if VALUES not in parts:
        raise ProfileError(f"{origin}: <{VALUES}>: value missing: parameter values for a scenario")
    axes: list[list[ValueSet]] = []
    for part in source.children(parts[VALUES], "ScenarioFile", "Deterministic"):
        if part.name == "Deterministic":
            axes += (_axis(source, one) for one in source.children(part, _SINGLE, _MULTI))
    if source.left:
        raise ProfileError(f"{origin}: {'; '.join(map(str, source.left[:MOST_TOLD]))}")
    if not 1 <= (count := math.prod(map(len, axes))) <= MOST_SETS:
        raise source.error(parts[VALUES], f"{count} sets of values: 1 to {MOST_SETS}")
    return [{name: value for one in sets for name, value in one.items()} for sets in product(*axes)]


def _axis(source: Source, element: Element) -> list[ValueSet]:
    """Return the sets of which one comes with each of the other axes'."""
    inner = source.one(element)
    if element.name == _MULTI:
        if inner.name == "ValueSetDistribution":
            return [_set(source, one) for one in source.children(inner, "ParameterValueSet")]
    else:
        name = source.text(element, "parameterName")
        if inner.name == "DistributionSet":
            return [{name: source.text(one, "value")} for one in source.children(inner, "Element")]
        if inner.name == "DistributionRange":
            return [{name: value} for value in _range(source, inner)]
    source.refuse(inner)
    return []


def _set(source: Source, element: Element) -> ValueSet:
    found = source.children(element, "ParameterAssignment")
    return {source.text(one, "parameterRef"): source.text(one, "value") for one in found}


def _range(source: Source, element: Element) -> Iterator[str]:
    """Yield the values of a range as people would write them, its upper limit included where a step falls on it."""
    step = source.number(element, "stepWidth", _NEAR, 1e9)
    limits = source.only(element, "Range")
    low = source.number(limits, "lowerLimit", -1e9, 1e9)
    high = source.number(limits, "upperLimit", low, 1e9)
    steps = (high - low) / step + _NEAR
    if steps >= MOST_SETS:
        raise source.error(element, f"more than {MOST_SETS} values")
    for number in range(int(steps) + 1):
        yield f"{low + number * step:.12g}"
