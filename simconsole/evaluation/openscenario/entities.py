"""Entities and their places: vehicles and people on foot of an OpenSCENARIO file."""

import math
import re
from typing import Any, Final, NamedTuple

from simconsole.evaluation.openscenario.reading import Source
from simconsole.world.sumo.xml_guard import Element

MAP_M: Final = 1e5
_VEHICLES: Final = {"car": "car", "van": "van", "truck": "van"}
_WALKERS: Final = {"pedestrian": "pedestrian"}
_BAD: Final = re.compile(r"[^A-Za-z0-9_.:-]", re.ASCII)
UNUSED: Final = "nobody is controlled by it: the vehicle has its own driver, others their acts"
"""What is said of a controller."""
_SILENT: Final = ("ParameterDeclarations", "Performance", "Axles", "Properties", "BoundingBox")


class Entity(NamedTuple):
    """An entity as it is declared."""

    name: str  # in the file
    label: str  # as an actor's name
    kind: str
    length_m: float
    width_m: float
    height_m: float
    ahead_m: float  # of its middle from the point that the file places


class Place(NamedTuple):
    """A place in the world, of the point that the file places; `yaw_rad` None: not told."""

    x_m: float
    y_m: float
    yaw_rad: float | None

    def middle(self, ahead_m: float, yaw_rad: float) -> tuple[float, float]:
        """Return where the middle is that lies so far ahead of the point."""
        return self.x_m + ahead_m * math.cos(yaw_rad), self.y_m + ahead_m * math.sin(yaw_rad)


def entities(source: Source, element: Element) -> dict[str, Entity]:
    """Return the entities by name.

    Raises:
        ProfileError: one cannot be read, or two have one name.
    """
    found: dict[str, Entity] = {}
    for child in source.children(element, "ScenarioObject"):
        name = source.text(child, "name")
        if name in found:
            raise source.error(child, f"name: value {name!a}: another name for each")
        label = _BAD.sub("_", name)[:40]
        label = label if label[:1].isalpha() or label[:1] == "_" else f"_{label}"
        if any(one.label == label for one in found.values()):
            label = f"{label}_{len(found)}"
        entity = _entity(source, child, label)
        if entity is not None:
            found[name] = entity._replace(name=name)
    return found


def position(source: Source, element: Element) -> Place | None:
    """Return the place of a <Position>; None: one that is not understood, and noted.

    Raises:
        ProfileError: it cannot be read.
    """
    kind = source.one(element)
    if kind.name != "WorldPosition":
        source.refuse(kind, "not understood: a WorldPosition")
        return None
    yaw_rad = None if "h" not in kind.attributes else source.number(kind, "h", -100.0, 100.0)
    return Place(source.number(kind, "x", -MAP_M, MAP_M), source.number(kind, "y", -MAP_M, MAP_M), yaw_rad)


def actor(entity: Entity, place: Place, speed_mps: float) -> dict[str, Any]:
    """Return an entity as the plain values of an actor without acts."""
    yaw_rad = place.yaw_rad or 0.0
    x_m, y_m = place.middle(entity.ahead_m, yaw_rad)
    return {
        "name": entity.label,
        "kind": entity.kind,
        "x_m": x_m,
        "y_m": y_m,
        "yaw_deg": math.degrees(math.remainder(yaw_rad, math.tau)),
        "speed_kmh": 3.6 * speed_mps,
        "length_m": entity.length_m,
        "width_m": entity.width_m,
        "height_m": entity.height_m,
    }


def _entity(source: Source, element: Element, label: str) -> Entity | None:
    found: Entity | None = None
    for child in element.children:
        if child.name == "ObjectController":
            if child.children:
                source.note(child, UNUSED)
        elif child.name in ("Vehicle", "Pedestrian") and found is None:
            kinds, attribute = (
                (_VEHICLES, "vehicleCategory") if child.name == "Vehicle" else (_WALKERS, "pedestrianCategory")
            )
            kind = source.choice(child, attribute, kinds)
            for part in child.children:
                if part.name not in _SILENT:
                    source.refuse(part)
            box = [part for part in child.children if part.name == "BoundingBox"]
            found = _sized(source, child, box, label, kind)
        else:
            source.refuse(child)
    if found is None and all(child.name == "ObjectController" for child in element.children):
        raise source.error(element, "a <Vehicle> or a <Pedestrian> in it")
    return found


def _sized(source: Source, element: Element, boxes: list[Element], label: str, kind: str) -> Entity:
    if len(boxes) != 1:
        raise source.error(element, f"{len(boxes)} <BoundingBox> in it: one")
    size, ahead_m = None, 0.0
    for part in source.children(boxes[0], "Center", "Dimensions"):
        if part.name == "Center":
            ahead_m = source.number(part, "x", -20.0, 20.0)
        else:
            size = (
                source.number(part, "length", 0.05, 30.0),
                source.number(part, "width", 0.05, 5.0),
                source.number(part, "height", 0.05, 6.0),
            )
    if size is None:
        raise source.error(boxes[0], "a <Dimensions> in it")
    return Entity("", label, kind, *size, ahead_m=ahead_m)
