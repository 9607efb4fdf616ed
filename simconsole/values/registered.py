"""What other packages have registered by an entry point: found by name, loaded, and of the type that it must be."""

import sys
from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache
from importlib.metadata import EntryPoint, entry_points
from typing import NamedTuple, TypeVar

from simconsole.values.errors import ProfileError, SimConsoleError, one_line

T = TypeVar("T")


class Bounded(NamedTuple):
    """A parameter: what it is unless the profile says otherwise, and between which values it may be."""

    default: float
    lowest: float
    highest: float


def found(group: str) -> Mapping[str, EntryPoint]:
    """Return what is registered in a group by name, in the order of the names."""
    return _found(group, tuple(sys.path))


@lru_cache(maxsize=16)
def _found(group: str, path: tuple[str, ...]) -> Mapping[str, EntryPoint]:
    """Look for it once for each path that modules are searched on: that reads the list of every package."""
    return {one.name: one for one in sorted(entry_points(group=group), key=lambda one: one.name)}


def load(group: str, name: str, wanted: type[T], key: str) -> T:
    """Return what is registered by that name.

    Args:
        group: of entry points.
        name: in it.
        wanted: what it must be.
        key: opens an error: where the name stands.

    Raises:
        ProfileError: there is none, it cannot be loaded, or is no such thing.
    """
    there = found(group)
    if name not in there:
        raise ProfileError(f"{key}: value {name}: one of {', '.join(there) or 'none'}, as packages register them")
    try:
        loaded = there[name].load()
    except Exception as error:  # whatever a stranger's module does when it is loaded
        raise ProfileError(f"{key}: value {name}: {there[name].value}: {one_line(error)}") from error
    if not isinstance(loaded, wanted):
        article = "an" if wanted.__name__[0] in "AEIO" else "a"
        raise ProfileError(f"{key}: value {name}: {there[name].value}: {article} {wanted.__name__}")
    return loaded


def identities(group: str) -> Iterator[str]:
    """Yield the name of everything that is registered in a group, with the package and its version."""
    for name, one in found(group).items():
        package = "" if one.dist is None else f" {one.dist.name} {one.dist.version}"
        yield f"{name} = {one.value}{package}"


def bounded_values(known: Mapping[str, Bounded], given: Mapping[str, float], key: str) -> dict[str, float]:
    """Return every parameter: the given values inside their bounds, else their defaults; `key` opens an error.

    Raises:
        ProfileError: one that there is not, or out of its bounds.
    """
    for name, value in given.items():
        if name not in known:
            raise ProfileError(f"{key}: {name}: one of {', '.join(known) or 'none'}")
        bounds = known[name]
        if not bounds.lowest <= value <= bounds.highest:
            raise ProfileError(f"{key}: {name}: value {value:g}: {bounds.lowest:g} to {bounds.highest:g}")
    return {name: given.get(name, bounds.default) for name, bounds in known.items()}


def made(make: Callable[[], T], flaws: Callable[[T], Iterator[str]], key: str) -> T:
    """Return what a registered function makes, once it is what it must be.

    Args:
        make: calls it.
        flaws: yields what is wrong with what it made.
        key: opens an error: where the name stands, and the name.

    Raises:
        ProfileError: it fails, or has made something else.
    """
    try:
        thing = make()
        wrong = next(flaws(thing), None)
    except SimConsoleError:
        raise
    except Exception as error:  # whatever a stranger's function does
        raise ProfileError(f"{key}: {one_line(error)}") from error
    if wrong is not None:
        raise ProfileError(f"{key}: {wrong}")
    return thing
