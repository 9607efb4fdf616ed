"""From an OpenSCENARIO file to a scenario of the console."""

import math
from collections.abc import Mapping
from typing import Any, Final, NamedTuple

from simconsole.evaluation.openscenario.distributions import VALUES
from simconsole.evaluation.openscenario.entities import Entity, actor, entities
from simconsole.evaluation.openscenario.reading import DECLARATIONS, MOST_TOLD, Left, Source, parts_of
from simconsole.evaluation.openscenario.storyboard import Told, storyboard
from simconsole.profiles.scenario import ScenarioProfile
from simconsole.profiles.validation import convert
from simconsole.values.errors import ProfileError
from simconsole.world.sumo.xml_guard import Element

EGO: Final = ("ego", "hero")
LANE_M: Final = 3.5
DURATION_S: Final = 30.0
_SILENT: Final = ("FileHeader", "ParameterDeclarations", "Entities", "Storyboard")
_NOTED: Final = {
    "CatalogLocations": "no catalogue is read",
    "RoadNetwork": "no road map is read: environment.world of the session",
}
_NO_CATALOGUES: Final = "CatalogLocations"


class Imported(NamedTuple):
    """A file as a scenario."""

    plain: dict[str, Any]  # its values, as they stand in YAML
    profile: ScenarioProfile
    left: tuple[Left, ...]


def imported(
    content: bytes,
    origin: str,
    *,
    ego: str | None = None,
    vehicle: str = "hatchback",
    lane_m: float = LANE_M,
    partly: bool = False,
    parameters: Mapping[str, str] | None = None,
) -> Imported:
    """Return an OpenSCENARIO file as a scenario.

    The console's vehicle begins where the file puts it, at rest, and a controller accelerates it to the speed that it
    begins with there. All others are actors.

    Args:
        content: the file.
        origin: its name, which opens every error.
        ego: which entity is the console's vehicle; one called ego or hero, without.
        vehicle: the profile that drives it.
        lane_m: how wide the lanes are that vehicles change to: no map is read.
        partly: import what is understood, even if the drive is another one then.
        parameters: values of those that the file declares, in the place of its own.

    Raises:
        ProfileError: no OpenSCENARIO, something cannot be read, or is not understood and changes the drive; names the
            elements with their lines.
    """
    source = Source(origin)
    parts = parts_of(content, origin)
    if VALUES in parts:
        raise source.error(parts[VALUES], "values for another file, which is imported with them: --values FILE")
    for name in ("FileHeader", "Entities", "Storyboard"):
        if name not in parts:
            raise ProfileError(f"{origin}: <{name}>: value missing: a scenario, and no catalogue")
    for name, part in parts.items():
        if name in _NOTED:
            if part.children or name != _NO_CATALOGUES:
                source.note(part, _NOTED[name])
        elif name not in _SILENT:
            source.refuse(part)
    _check_version(source, parts["FileHeader"])
    if DECLARATIONS in parts:
        source.declare(parts[DECLARATIONS], parameters)
    _check_given(origin, source.parameters, parameters or {})
    known = entities(source, parts["Entities"])
    driven = _ego(source, parts["Entities"], known, ego)
    told = storyboard(source, parts["Storyboard"], driven, known, lane_m)
    plain = _scenario(source, parts, known, driven, told, vehicle)
    lost = [str(one) for one in source.left if one.changes]
    if lost and not partly:
        more = f"; and {len(lost) - MOST_TOLD} more" if len(lost) > MOST_TOLD else ""
        raise ProfileError(f"{origin}: {'; '.join(lost[:MOST_TOLD])}{more} (--partly imports the rest)")
    return Imported(plain, convert(plain, ScenarioProfile, origin), tuple(source.left))


def _check_version(source: Source, element: Element) -> None:
    major = source.text(element, "revMajor")
    if major != "1":
        raise source.error(element, f"revMajor: value {major!a}: 1")


def _check_given(origin: str, declared: Mapping[str, str], given: Mapping[str, str]) -> None:
    for name in given:
        if name not in declared:
            raise ProfileError(f"{origin}: --parameter: value {name}: one of {', '.join(declared) or 'none'}")


def _ego(source: Source, element: Element, known: dict[str, Entity], wanted: str | None) -> str:
    names = [name for name in known if (name == wanted if wanted is not None else name.lower() in EGO)]
    if len(names) != 1:
        said = wanted or " or ".join(EGO)
        raise source.error(element, f"{len(names)} entities called {said}: one, the console's vehicle (--ego NAME)")
    if known[names[0]].kind == "pedestrian":
        raise source.error(element, f"{names[0]!a} is a pedestrian: the console's vehicle is a vehicle")
    return names[0]


def _scenario(
    source: Source, parts: dict[str, Element], known: dict[str, Entity], driven: str, told: Told, vehicle: str
) -> dict[str, Any]:
    actors = _actors(source, parts, known, driven, told)
    own = told.beginnings.get(driven)
    speed_mps = 0.0 if own is None else own.speed_mps
    duration_s = told.end_s or DURATION_S
    title = parts["FileHeader"].attributes.get("description", "")
    plain: dict[str, Any] = {
        "schema": 1,
        "title": "".join(letter for letter in title if letter.isprintable())[:200] or source.origin,
        "duration_s": duration_s,
        "session": {
            "schema": 1,
            "scenario": {"vehicle": vehicle},
            "features": {"control": {"person_required": False}},
            "devices": {"driver": "none"},
        },
        "golden_hz": 1,
    }
    if own is not None and own.place is not None:
        yaw_deg = math.degrees(math.remainder(own.place.yaw_rad or 0.0, math.tau))
        plain["session"]["scenario"]["start"] = {"x_m": own.place.x_m, "y_m": own.place.y_m, "yaw_deg": yaw_deg}
    events = [*told.acts.get(driven, ())]
    if speed_mps > 0.0 or events:
        plain["remote"] = [{"start_s": 0.1, "end_s": duration_s, "kind": "speed", "speed_mps": speed_mps}]
        if own is None or own.active:
            events.insert(0, {"event": "request_autonomous", "at_s": 0.5})
        plain["events"] = events
    if actors:
        plain["actors"] = actors
    return plain


def _actors(
    source: Source, parts: dict[str, Element], known: dict[str, Entity], driven: str, told: Told
) -> list[dict[str, Any]]:
    """Return everybody but the console's vehicle; who has no place is listed, and left out with all that names it."""
    places = {name: one.place for name, one in told.beginnings.items() if one.place is not None and name in known}
    lost = {entity.label for name, entity in known.items() if name not in places and name != driven}
    actors, named = [], dict.fromkeys(lost, 0)
    understood = not any(one.changes for one in source.left)
    for name, entity in known.items():
        if name == driven or name not in places:
            continue
        acts = []
        for act in told.acts[name]:
            gone = lost & {act.get("of"), act.get("to")}
            for label in gone:
                named[label] += 1
            if not gone:
                acts.append(act)
        actors.append({**actor(entity, places[name], told.beginnings[name].speed_mps), "acts": acts})
    for element in parts["Entities"].children:
        one = known.get(element.attributes.get("name", ""))
        if one is None or one.name in places:
            continue
        if understood:
            raise source.error(parts["Storyboard"], f"entity {one.name!a}: a <TeleportAction> in <Init>")
        why = f"{one.name!a}: no place in <Init> that is understood: left out"
        if one.name == driven:
            why = why.replace("left out", "it begins where every vehicle does")
        elif number := named[one.label]:
            why += f", and {number} act{'s' * (number > 1)} of others that name{'s' * (number == 1)} it"
        source.refuse(element, why)
    return actors
