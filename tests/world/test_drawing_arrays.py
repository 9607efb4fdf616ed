import io

import numpy as np
import pytest

from simconsole.profiles.files.loader import load
from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.world import CourseProfile
from simconsole.world.course import Course
from simconsole.world.drawing import draw
from simconsole.world.drawing_arrays import from_arrays, to_arrays
from simconsole.world.kinds.worlds import open_world
from tests.bits import difference


def test_a_drawing_comes_out_of_a_file_as_it_went_in() -> None:
    drawing = draw(Course(load("worlds", "urban", CourseProfile)))
    file = io.BytesIO()
    np.savez(file, **to_arrays(drawing))
    file.seek(0)
    with np.load(file, allow_pickle=False) as content:
        back = from_arrays(content)
    assert back is not None
    assert back.lights == drawing.lights
    assert (back.path == drawing.path).all()
    for name in ("surfaces", "islands", "edges", "centre_lines", "zebras", "stop_lines"):
        lines, wanted = getattr(back, name), getattr(drawing, name)
        assert len(lines) == len(wanted) > 0
        assert all((one == other).all() for one, other in zip(lines, wanted, strict=True))


def test_programs_of_lights_come_along() -> None:
    drawing = open_world(load_world("urban_signals")).drawing
    assert any(light.program is not None for light in drawing.lights)
    file = io.BytesIO()
    np.savez(file, **to_arrays(drawing))
    file.seek(0)
    with np.load(file, allow_pickle=False) as content:
        back = from_arrays(content)
    assert back is not None
    assert back.lights == drawing.lights


def test_no_drawing_is_none_and_a_part_of_one_is_an_error() -> None:
    assert from_arrays({}) is None
    with pytest.raises(KeyError):
        from_arrays({"path": np.zeros((2, 2))})


def test_the_ground_comes_back_with_the_drawing() -> None:
    drawing = open_world(load_world("country")).drawing
    again = from_arrays(to_arrays(drawing))
    assert drawing.ground is not None
    assert again is not None
    assert again.ground is not None
    assert again.ground.grid == drawing.ground.grid
    assert not difference(again.ground.nodes, drawing.ground.nodes)
