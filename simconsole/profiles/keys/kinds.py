"""The kinds of files that people write, and the pages of the documents that say more about a part of them."""

from typing import Any, Final, NamedTuple

from simconsole.profiles.course_plan import CoursePlan
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.parts.script import ScriptProfile
from simconsole.profiles.scenario import ScenarioProfile
from simconsole.profiles.session import SessionProfile
from simconsole.profiles.sweep import SweepProfile
from simconsole.profiles.vehicle import VehicleProfile
from simconsole.profiles.view import LanguageProfile
from simconsole.profiles.world import WorldProfile


class Kind(NamedTuple):
    """One kind of file."""

    profile: Any  # its struct, or the union of several
    schema: str  # the name of its schema, as in docs/schemas
    shipped: str  # pattern of the shipped files below profiles/; empty: none is shipped
    page: str  # of the documents


KINDS: Final = {
    "session": Kind(SessionProfile, "session", "sessions/*.yaml", "docs/own/session.md"),
    "scenario": Kind(ScenarioProfile, "scenario", "scenarios/**/*.yaml", "docs/scenarios.md"),
    "vehicle": Kind(VehicleProfile, "vehicle", "vehicles/*.yaml", "docs/own/vehicle.md"),
    "world": Kind(WorldProfile, "world", "worlds/*.yaml", "docs/own/world.md"),
    "plan": Kind(CoursePlan, "plan", "worlds/*.plan.yaml", "docs/own/world.md"),
    "cockpit": Kind(CockpitProfile, "device", "devices/*.yaml", "docs/cockpit.md"),
    "language": Kind(LanguageProfile, "language", "languages/*.yaml", "docs/cockpit.md"),
    "script": Kind(ScriptProfile, "script", "sessions/scripts/*.yaml", "docs/scenarios.md"),
    "sweep": Kind(SweepProfile, "sweep", "", "docs/sweeps.md"),
}
"""The session stands before the scenario, which has one inside."""

PAGES: Final = {
    "outputs.bridge.link": "docs/tracking.md",
    "outputs.bridge.ros2": "docs/ros2.md",
    "outputs.bridge": "docs/rosbridge.md",
    "outputs.can": "docs/can.md",
    "outputs": "docs/operators.md",
    "features.control": "docs/modes.md",
    "scenario.faults": "docs/faults.md",
    "scenario.platforms": "docs/robots.md",
    "environment.traffic": "docs/traffic.md",
    "manoeuvre": "docs/handling.md",
    "limits": "docs/handling.md",
}
"""Pages of parts of sessions and scenarios, by the beginning of a key; the first that fits counts."""


def page_of(kind: str, keys: str) -> str:
    """Return the page about a key; `keys` is its path without the kind."""
    inner = keys.removeprefix("session.") if kind == "scenario" else keys
    if kind in ("session", "scenario"):
        for begin, page in PAGES.items():
            if inner == begin or inner.startswith((f"{begin}.", f"{begin}[")):
                return page
    return KINDS[kind].page
