from simconsole.hud.layout import layout
from simconsole.values.signals import Mode
from tests.hud.pictures import SCREEN, by_role, in_mode, shape_of


def test_modes_differ_by_shape_and_not_only_by_colour() -> None:
    shapes = {}
    for mode in Mode:
        items = by_role(layout(in_mode(mode), SCREEN), "mode.shape")
        shapes[mode] = tuple(shape_of(item) for item in items)
    assert len(set(shapes.values())) == len(Mode)
