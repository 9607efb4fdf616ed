"""The elements of an OpenSCENARIO file: their attributes as numbers and words, and a list of what is not understood."""

import math
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Final, NamedTuple

from simconsole.values.errors import ProfileError
from simconsole.world.sumo.xml_guard import Element, read_elements, shown

DEPTH: Final = 40
"""A vertex of a trajectory lies 18 deep."""
ROOT: Final = "OpenSCENARIO"
DECLARATIONS: Final = "ParameterDeclarations"
MOST_TOLD: Final = 12
"""Elements that one error names."""
_PARAMETER: Final = re.compile(r"\$([A-Za-z_][A-Za-z0-9_]*)")


class Left(NamedTuple):
    """An element that was left out, and why."""

    line: int
    element: str
    why: str
    changes: bool  # whether the drive is another one without it

    def __str__(self) -> str:
        """Return it as one line."""
        return f"line {self.line}: <{shown(self.element)}>: {self.why}"


class Source:
    """One file being read.

    Attributes:
        origin: its name, which opens every error.
        left: what was left out so far.
        parameters: by name, without the dollar.
    """

    def __init__(self, origin: str) -> None:
        self.origin = origin
        self.left: list[Left] = []
        self.parameters: dict[str, str] = {}

    def refuse(self, element: Element, why: str = "not understood") -> None:
        """Note an element that changes the drive and is left out."""
        self.left.append(Left(element.line, element.name, why, True))

    def note(self, element: Element, why: str) -> None:
        """Note an element that changes nothing of what is driven."""
        self.left.append(Left(element.line, element.name, why, False))

    def error(self, element: Element, why: str) -> ProfileError:
        """Return the error that an element cannot be read."""
        return ProfileError(f"{self.origin}: line {element.line}: <{shown(element.name)}>: {why}")

    def declare(self, element: Element, given: Mapping[str, str] | None = None) -> None:
        """Take the parameters of a <ParameterDeclarations>; `given` values stand in the place of its own.

        Raises:
            ProfileError: one has no value, or comes twice.
        """
        own: set[str] = set()
        for one in self.children(element, "ParameterDeclaration"):
            name = self.text(one, "name")
            if name in own:
                raise self.error(one, f"name: value {name!a}: another name for each")
            for constraint in one.children:
                self.note(constraint, "not checked")
            own.add(name)
            self.parameters[name] = given[name] if given is not None and name in given else self.text(one, "value")

    @contextmanager
    def scope(self, element: Element) -> Iterator[None]:
        """Within the block the parameters count that an element declares, before those of the same name around it.

        Raises:
            ProfileError: as `declare`.
        """
        around = dict(self.parameters)
        for part in element.children:
            if part.name == DECLARATIONS:
                self.declare(part)
        try:
            yield
        finally:
            self.parameters = around

    def text(self, element: Element, attribute: str, default: str | None = None) -> str:
        """Return an attribute, a parameter in its place.

        Raises:
            ProfileError: it is missing, an expression, or names no parameter.
        """
        value = element.attributes.get(attribute, default)
        if value is None:
            raise self.error(element, f"{attribute}: value missing")
        if not value.startswith("$"):
            return value
        named = _PARAMETER.fullmatch(value)
        if named is None:
            raise self.error(element, f"{attribute}: value {shown(value)}: a value or a parameter, no expression")
        if named[1] not in self.parameters:
            raise self.error(element, f"{attribute}: value {shown(value)}: no such parameter")
        return self.parameters[named[1]]

    def number(self, element: Element, attribute: str, low: float, high: float, default: float | None = None) -> float:
        """Return an attribute as a number.

        Raises:
            ProfileError: it is missing, no number, or outside `low` to `high`.
        """
        if default is not None and attribute not in element.attributes:
            return default
        text = self.text(element, attribute)
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not low <= value <= high:
            raise self.error(element, f"{attribute}: value {shown(text)}: a number from {low:g} to {high:g}")
        return value

    def choice(self, element: Element, attribute: str, known: Mapping[str, str], default: str | None = None) -> str:
        """Return what an attribute's word means.

        Raises:
            ProfileError: it is another word.
        """
        word = self.text(element, attribute, default)
        if word not in known:
            raise self.error(element, f"{attribute}: value {shown(word)}: one of {', '.join(known)}")
        return known[word]

    def only(self, element: Element, name: str) -> Element:
        """Return the one child of that name; all others are refused.

        Raises:
            ProfileError: there is none, or several.
        """
        found = [child for child in element.children if child.name == name]
        for child in element.children:
            if child.name != name:
                self.refuse(child)
        if len(found) != 1:
            raise self.error(element, f"{len(found)} <{name}> in it: one")
        return found[0]

    def one(self, element: Element) -> Element:
        """Return the only child.

        Raises:
            ProfileError: there is none, or several.
        """
        if len(element.children) != 1:
            raise self.error(element, f"{len(element.children)} elements in it: one")
        return element.children[0]

    def children(self, element: Element, *known: str) -> Iterator[Element]:
        """Yield the children of these names, in order; all others are refused."""
        for child in element.children:
            if child.name in known:
                yield child
            else:
                self.refuse(child)


def parts_of(content: bytes, origin: str) -> dict[str, Element]:
    """Return the children of the root element by name.

    Raises:
        ProfileError: no XML, no OpenSCENARIO, or one of them comes twice.
    """
    found: dict[str, Element] = {}

    def take(element: Element) -> None:
        if element.name in found:
            raise ProfileError(f"{origin}: line {element.line}: <{shown(element.name)}>: comes twice")
        found[element.name] = element

    read_elements(content, origin, ROOT, take, DEPTH)
    return found
