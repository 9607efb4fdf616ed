"""Elements of an OpenSCENARIO file, written by hand."""

from simconsole.evaluation.openscenario.entities import Entity
from simconsole.world.sumo.xml_guard import Element

LEAD = Entity("Lead", "Lead", "car", 4.5, 1.8, 1.5, ahead_m=1.4)


def element(kind: str, /, *children: Element, **attributes: str) -> Element:
    """Return an element of line 1."""
    return Element(kind, 1, attributes, list(children))


def place(x: float, y: float, **heading: str) -> Element:
    """Return a <Position> in the world."""
    return element("Position", element("WorldPosition", x=str(x), y=str(y), **heading))
