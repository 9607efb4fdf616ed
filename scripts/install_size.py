"""What an installation without extras takes on disk, library by library: `python scripts/install_size.py`.

It follows the requirements of the package from name to name through what is installed in this environment, and adds
up the files that each distribution's RECORD names, and their byte code. docs/install.md has its table from here.
"""

import re
from collections.abc import Iterator
from importlib.metadata import Distribution, PackageNotFoundError, distribution
from pathlib import Path

from packaging.requirements import Requirement

ROOT = "simconsole"


def name_of(text: str) -> str:
    """Return a distribution's name as the index writes it."""
    return re.sub(r"[-_.]+", "-", text).lower()


def required(of: Distribution, extras: frozenset[str]) -> Iterator[tuple[str, frozenset[str]]]:
    """Yield what a distribution needs here: the name and the extras of it."""
    for text in of.requires or ():
        needed = Requirement(text)
        wanted = [needed.marker is None or needed.marker.evaluate({"extra": extra}) for extra in extras or {""}]
        if any(wanted):
            yield name_of(needed.name), frozenset(needed.extras)


def installed() -> dict[str, Distribution]:
    """Return every library that the package needs without extras, by name.

    Raises:
        SystemExit: one of them is not installed here.
    """
    found: dict[str, Distribution] = {}
    seen: set[tuple[str, frozenset[str]]] = set()
    left = [(ROOT, frozenset[str]())]
    while left:
        name, extras = left.pop()
        if (name, extras) in seen:
            continue
        seen.add((name, extras))
        try:
            found[name] = distribution(name)
        except PackageNotFoundError:
            raise SystemExit(f"install_size: {name} is not installed here") from None
        left += required(found[name], extras)
    del found[ROOT]
    return found


def size_bytes(of: Distribution) -> int:
    """Return the size of the files of a distribution in bytes, each counted once."""
    paths = {Path(str(of.locate_file(file))).resolve() for file in of.files or ()}
    return sum(path.stat().st_size for path in paths if path.is_file())


def main() -> None:
    """Print the table, largest first."""
    sizes = {name: size_bytes(one) for name, one in installed().items()}
    for name, size in sorted(sizes.items(), key=lambda pair: -pair[1]):
        print(f"{name:<24} {size / 1e6:7.1f} MB")
    print(f"{'together':<24} {sum(sizes.values()) / 1e6:7.1f} MB in {len(sizes)} libraries")


if __name__ == "__main__":
    main()
