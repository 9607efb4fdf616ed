"""A map's signals as another simulator runs them, and as the log and shared memory have them."""

import json
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, Final, NamedTuple

from simconsole.world.roads.road_map import Phase

_FAR: Final = 1e9  # as values.signals has it: never, or nobody knows


class Running(NamedTuple):
    """A signal as it runs now."""

    letters: str  # of its links, as SUMO writes them
    phases: tuple[Phase, ...]  # of its program
    phase: int
    switch_tick: float  # when this phase ends; FAR: nobody knows


RunningNow = Mapping[str, Running]
"""By the names of the signals; without any they run the map's own programs."""
NONE_RUNNING: Final[RunningNow] = MappingProxyType({})


def changes(before: RunningNow, now: RunningNow) -> bytes | None:
    """Return what has changed as JSON, None where nothing has; a program's phases only where they are others."""
    said: dict[str, Any] = {}
    for name, one in now.items():
        was = before.get(name)
        if was == one:
            continue
        said[name] = {"states": one.letters, "switch_tick": one.switch_tick, "phase": one.phase}
        if was is None or was.phases != one.phases:
            said[name]["phases"] = one.phases
    said |= dict.fromkeys(before.keys() - now.keys())
    return json.dumps(said, sort_keys=True, separators=(",", ":")).encode() if said else None


def changed(before: RunningNow, content: bytes) -> RunningNow:
    """Return the signals after changes that `changes` has written; logs of before had neither phase nor phases.

    Raises:
        ValueError: it is nothing that `changes` has written.
    """
    now = dict(before)
    try:
        for name, one in json.loads(content).items():
            if one is None:
                now.pop(name, None)
                continue
            was = before.get(name)
            phases = () if was is None else was.phases
            if "phases" in one:
                phases = tuple(Phase(float(duration_s), str(letters)) for duration_s, letters in one["phases"])
            switch_tick = float(one["switch_tick"]) if phases else _FAR
            now[name] = Running(str(one["states"]), phases, int(one.get("phase", 0)), switch_tick)
    except (AttributeError, KeyError, TypeError, ValueError) as problem:
        raise ValueError(f"signals: {problem}") from None
    return now
