"""XML from strangers: read by expat within bounds, one child of the root after the other.

Refused, each with its line: declarations of documents and entities (the XML bomb), nesting past MAX_DEPTH, more than
MAX_ELEMENTS elements in all or MAX_CHILDREN in one, more than MAX_ATTRIBUTES attributes. Nothing that a file names is
ever fetched.
"""

from collections.abc import Callable
from typing import Final, NamedTuple
from xml.parsers import expat

from simconsole.values.errors import ProfileError

MAX_DEPTH: Final = 16
MAX_ELEMENTS: Final = 500_000
MAX_ATTRIBUTES: Final = 64
MAX_CHILDREN: Final = 20_000
"""In one child of the root: as much is in memory at a time."""
_SHOWN: Final = 40


class Element(NamedTuple):
    """An element with its place, attributes and children."""

    name: str
    line: int
    attributes: dict[str, str]
    children: list["Element"]


def read_elements(
    content: bytes, origin: str, root: str, take: Callable[[Element], None], depth: int = MAX_DEPTH
) -> None:
    """Give each child of the root element to `take`, whole, in order.

    Args:
        content: the file.
        origin: its name, which opens every message.
        root: the name that the root element must have.
        take: called with each child; only one is in memory at a time.
        depth: how deep elements may lie in each other.

    Raises:
        ProfileError: not XML, another root, or one of the bounds is exceeded; names line and element.
    """
    reader = _Reader(origin, root, take, depth)
    try:
        reader.parser.Parse(content, True)
    except expat.ExpatError as error:
        what = expat.errors.messages.get(error.code, "unreadable")
        raise ProfileError(f"{origin}: line {error.lineno}: not XML: {what}") from None
    except (LookupError, UnicodeError, ValueError) as error:  # an encoding that this Python does not know
        raise ProfileError(f"{origin}: line 1: not XML: {shown(str(error))}") from None


def shown(text: str) -> str:
    """Return a stranger's text for a message: printable and short."""
    plain = ascii(text)[1:-1]
    return plain if len(plain) <= _SHOWN else f"{plain[: _SHOWN - 3]}..."


class _Reader:
    def __init__(self, origin: str, root: str, take: Callable[[Element], None], depth: int) -> None:
        self._origin, self._root, self._take, self._most_depth = origin, root, take, depth
        self._open: list[Element] = []
        self._depth = self._elements = self._held = 0
        self.parser = expat.ParserCreate()
        self.parser.buffer_text = True
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.StartDoctypeDeclHandler = self._doctype
        self.parser.EntityDeclHandler = self._entity
        self.parser.ExternalEntityRefHandler = self._entity

    def _refused(self, element: str, problem: str) -> ProfileError:
        line = self.parser.CurrentLineNumber
        return ProfileError(f"{self._origin}: line {line}: <{shown(element)}>: {problem}")

    def _doctype(self, name: str, *rest: object) -> None:
        raise self._refused("!DOCTYPE", "refused: a map without document type and entities")

    def _entity(self, *rest: object) -> int:
        raise self._refused("!ENTITY", "refused: a map without document type and entities")

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        depth = self._depth = self._depth + 1
        self._elements += 1
        if depth > self._most_depth:
            raise self._refused(name, f"nested more than {self._most_depth} deep: at most {self._most_depth}")
        if self._elements > MAX_ELEMENTS:
            raise self._refused(name, f"more than {MAX_ELEMENTS} elements: at most {MAX_ELEMENTS}")
        if len(attributes) > MAX_ATTRIBUTES:
            raise self._refused(name, f"{len(attributes)} attributes: at most {MAX_ATTRIBUTES}")
        if depth == 1:
            if name != self._root:
                raise self._refused(name, f"value {shown(name)}: <{self._root}> as the first element")
            return
        element = Element(name, self.parser.CurrentLineNumber, attributes, [])
        if depth == 2:
            self._held = 0
        else:
            self._held += 1
            if self._held > MAX_CHILDREN:
                raise self._refused(name, f"more than {MAX_CHILDREN} elements in one: at most {MAX_CHILDREN}")
            self._open[-1].children.append(element)
        self._open.append(element)

    def _end(self, name: str) -> None:
        self._depth -= 1
        if self._open:
            element = self._open.pop()
            if not self._open:
                self._take(element)
