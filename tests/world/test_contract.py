"""What every world must be: each flaw is named."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from simconsole.profiles.files.world_files import load_world
from simconsole.world.contract import problems
from simconsole.world.kinds.worlds import open_world
from simconsole.world.world import World
from tests.world.made import world


def broken(key: str, value: Any) -> World:
    found = world()
    found.__dict__["drawing"] = found.drawing._replace(**{key: value})
    return found


def jumps() -> World:
    found = world()
    route = open_world(load_world("urban")).route
    moved = route._cells[100]
    cells = [*route._cells]
    cells[100] = (moved[0] + 1.0, *moved[1:])
    other = object.__new__(type(route))
    other.__dict__ = {**route.__dict__, "_cells": cells}
    found.route = other
    return found


@pytest.mark.parametrize(
    ("made", "told"),
    [
        (world, ""),
        (jumps, "route: at "),
        (lambda: broken("path", np.zeros((1, 2))), "drawing: path: fewer than two points"),
        (lambda: broken("edges", (np.zeros((3, 3)),)), "drawing: edges: a float64 array"),
        (lambda: broken("edges", (np.full((3, 2), np.nan),)), "drawing: edges: a value is not finite"),
    ],
)
def test_the_contract_names_what_is_wrong(made: Callable[[], World], told: str) -> None:
    found = problems(made(), made())
    assert [one[: len(told)] for one in found] == ([told] if told else [])


def test_a_world_must_be_made_anew_and_alike() -> None:
    one = world()
    assert problems(one, one) == ["made a second time: the same object: it must be made anew"]
    assert problems(one, broken("path", np.zeros((5, 2)))) == ["made a second time: another drawing"]
    other = world(route=open_world(load_world("urban")).route)
    assert problems(one, other) == ["made a second time: another route"]
