"""Values of a scenario's own in a sweep, beside those of its session: actors' gaps and speeds, when events come.

A key begins with `scenario.` and what a scenario has beside its session: `scenario.actors.lead.speed_kmh`,
`scenario.actors.lead.acts.0.gap_below_m`, `scenario.events.1.at_s`. What is in a list is called by its name, or by its
place from 0.
"""

from collections.abc import Mapping
from typing import Any, Final

import msgspec

from simconsole.profiles.scenario import ScenarioProfile
from simconsole.profiles.session import Scenario
from simconsole.profiles.sweep import Value
from simconsole.profiles.validation import convert
from simconsole.values.errors import ProfileError

_PREFIX: Final = "scenario"
_OWN: Final = {*ScenarioProfile.__struct_fields__} - {*Scenario.__struct_fields__} - {"schema", "title", "session"}


def of_scenario(values: Mapping[str, Value]) -> tuple[dict[str, Value], dict[str, Value]]:
    """Return the values of a scenario's own, and all others: `scenario.vehicle` is the session's."""
    own = {key: value for key, value in values.items() if _is_own(key)}
    return own, {key: value for key, value in values.items() if key not in own}


def _is_own(key: str) -> bool:
    steps = key.split(".")
    return steps[0] == _PREFIX and len(steps) > 1 and steps[1] in _OWN


def with_scenario_values(
    scenario: ScenarioProfile | None, values: Mapping[str, Value], origin: str
) -> ScenarioProfile | None:
    """Return a scenario with values of its own; `origin` opens an error.

    Raises:
        ProfileError: a session is driven and no scenario, there is no such key, or a value is out of its bounds.
    """
    if not values:
        return scenario
    if scenario is None:
        raise ProfileError(f"{origin}: {next(iter(values))}: a session has no such value: of scenarios only")
    plain = msgspec.to_builtins(scenario)
    for key, value in values.items():
        _, *way, last = key.split(".")
        at: Any = plain
        for step in way:
            at = at[_place(at, step, f"{origin}: {key}")]
        at[_place(at, last, f"{origin}: {key}", new=True)] = value
    return convert(plain, ScenarioProfile, origin)


def _place(at: Any, step: str, origin: str, new: bool = False) -> str | int:
    """Return by what `step` is found in `at`; in a section a `new` key may be one that is left out so far."""
    if isinstance(at, dict) and (new or step in at):
        return step
    if isinstance(at, list | tuple):
        if step.isdigit() and int(step) < len(at):
            return int(step)
        for number, one in enumerate(at):
            if isinstance(one, dict) and one.get("name") == step:
                return number
        named = [one["name"] for one in at if isinstance(one, dict) and "name" in one]
        known = ", ".join(named) if named else f"0 to {len(at) - 1}" if at else "nothing"
        raise ProfileError(f"{origin}: {step}: one of {known}")
    raise ProfileError(f"{origin}: {step}: no such key")
