"""Find keys by a path, by the end of one, or by a few names of it."""

from simconsole.profiles.keys.catalogue import Key, catalogue
from simconsole.profiles.keys.kinds import KINDS
from simconsole.values.errors import ProfileError, near


def top_keys(kind: str) -> list[Key]:
    """Return the keys that stand at the top of a kind of file."""
    return [key for key in catalogue() if key.kind == kind and key.path.count(".") == 1]


def keys_below(key: Key) -> list[Key]:
    """Return the keys of the section that a key holds."""
    inner = [(one, _names(one.path)) for one in catalogue() if one.kind == key.kind]
    own = _names(key.path)
    return [one for one, names in inner if names[:-1] == own]


def find_keys(asked: str) -> list[Key]:
    """Return the keys that a user may mean: those whose path ends so, else those with these names in this order.

    Equal keys of several places, as those of a session inside of a scenario, are there once, at the first of them.

    Args:
        asked: `ratio`, `steering.ratio`, `session.scenario.vehicle`, `session.vehicle`; `[]` and `[0]` may be left out.

    Raises:
        ProfileError: no key is called so; the message guesses.
    """
    wanted = _names(asked)
    for fits in (_is, _ends, _holds):
        found = [key for key in catalogue() if fits(_names(key.path), wanted)]
        if found:
            first = {(key.owner, key.name, key.description): key for key in reversed(found)}
            return [key for key in found if key in first.values()]
    raise ProfileError(f"command line: KEY: value {asked}: {_guess(asked, wanted)}")


def places(key: Key) -> list[str]:
    """Return every path at which a key stands, that of the key first."""
    same = [one.path for one in catalogue() if one[2:5] == key[2:5] and one.name == key.name]
    return [key.path, *dict.fromkeys(path for path in same if path != key.path)]


def _names(path: str) -> list[str]:
    """Return the names of a path, without what says that something is one of a list or a mapping."""
    return [name.partition("[")[0].partition("{")[0] for name in path.split(".")]


def _is(names: list[str], wanted: list[str]) -> bool:
    return names == wanted


def _ends(names: list[str], wanted: list[str]) -> bool:
    return names[-len(wanted) :] == wanted


def _holds(names: list[str], wanted: list[str]) -> bool:
    rest = iter(names)
    return names[-1] == wanted[-1] and all(name in rest for name in wanted)


def _guess(asked: str, wanted: list[str]) -> str:
    known = {key.name for key in catalogue()}
    guess = near(asked, [key.path for key in catalogue()]) if len(wanted) > 1 else ""
    guess = guess or near(wanted[-1], [*sorted(known), *KINDS])
    return f"did you mean {guess}?" if guess else f"a key, or one of {', '.join(KINDS)}"
