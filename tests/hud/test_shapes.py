import pytest

from simconsole.hud.draw import BACKGROUND, TEXT, Box, Polygon, bounds
from simconsole.hud.layout import layout
from simconsole.hud.shapes import mode_shape
from simconsole.values.signals import Mode
from tests.hud.pictures import SCREEN, by_role, in_mode, shape_of


def test_modes_differ_by_shape_and_not_only_by_colour() -> None:
    shapes = {}
    for mode in Mode:
        items = by_role(layout(in_mode(mode), SCREEN), "mode.shape")
        shapes[mode] = tuple(shape_of(item) for item in items)
    assert len(set(shapes.values())) == len(Mode)


@pytest.mark.parametrize("mode", [*map(float, Mode), 99.0])
def test_every_shape_stays_in_its_box_and_grows_with_it(mode: float) -> None:
    """A triangle on its tip, and one with a mark, stand out of it by a tenth at most."""
    for size in (20.0, 200.0):
        box = Box(300.0, 400.0, size, size)
        found = [bounds(item) for item in mode_shape(mode, box, TEXT, BACKGROUND)]
        assert found
        for part in found:
            assert min(part.x - box.x, part.y - box.y) >= -0.101 * size
            assert max(part.right - box.right, part.bottom - box.bottom) <= 0.101 * size
        assert max(part.w for part in found) > 0.75 * size


def test_a_mode_that_is_none_has_a_shape_of_its_own() -> None:
    box = Box(0.0, 0.0, 100.0, 100.0)
    (diamond,) = mode_shape(99.0, box, TEXT, BACKGROUND)
    assert isinstance(diamond, Polygon)
    assert len(diamond.points) == 4
    assert not any(mode_shape(float(mode), box, TEXT, BACKGROUND) == [diamond] for mode in Mode)
