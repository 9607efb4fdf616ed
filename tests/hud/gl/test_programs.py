import pytest

from simconsole.hud.gl.programs import SURFACE_FRAGMENT, SURFACE_VERTEX, variant
from tests.hud.gl.pictures import context


@pytest.mark.parametrize("shadows", [False, True])
@pytest.mark.parametrize("detail", [False, True])
def test_every_variant_compiles_and_has_only_what_it_is_for(shadows: bool, detail: bool) -> None:
    program = context().program(
        vertex_shader=variant(SURFACE_VERTEX, shadows=shadows, detail=detail),
        fragment_shader=variant(SURFACE_FRAGMENT, shadows=shadows, detail=detail),
    )
    assert ("shadow_map" in program) == shadows
    program.release()


def test_a_variant_begins_with_its_version() -> None:
    assert variant(SURFACE_VERTEX, shadows=True, detail=True).startswith(
        "#version 330\n#define SHADOWS\n#define DETAIL\n"
    )
