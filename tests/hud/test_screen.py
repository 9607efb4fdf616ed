import pytest

from tests.hud.pictures import SCREEN


def test_pixels_per_degree_are_those_of_the_reference_seat() -> None:
    # 1400 px on 1.6 m at 2.2 m are 34 px per degree.
    assert SCREEN.px_per_arcmin * 60.0 == pytest.approx(34.0, abs=0.5)
