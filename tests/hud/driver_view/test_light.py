import numpy as np
import pytest

from simconsole.hud.driver_view.light import DAY, NIGHT, Light, reach_m, shadow_matrix


@pytest.mark.parametrize("light", [DAY, NIGHT])
def test_a_shadow_map_looks_from_the_sun(light: Light) -> None:
    centre = np.array((120.0, -40.0, 0.0))
    matrix = shadow_matrix(light, centre, 70.0)
    assert np.linalg.norm(light.sun) == pytest.approx(1.0)

    def place(point: np.ndarray) -> np.ndarray:
        return np.asarray((matrix @ np.append(point, 1.0))[:3])

    assert place(centre) == pytest.approx(np.zeros(3), abs=1e-12)
    nearer = place(centre + 10.0 * np.array(light.sun))
    assert nearer[:2] == pytest.approx((0.0, 0.0), abs=1e-12)  # a shadow falls along the light
    assert nearer[2] < 0.0  # and what is nearer to the sun hides what is behind


def test_one_sees_further_by_day() -> None:
    assert reach_m(DAY) > 2.0 * reach_m(NIGHT) * 0.9
    assert reach_m(NIGHT) > 500.0
