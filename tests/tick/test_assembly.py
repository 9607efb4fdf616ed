"""From profiles to a console."""

import pytest

from simconsole.profiles.session import Environment, FrictionPatch
from simconsole.tick.assembly import ground_of
from simconsole.values.platform import Patch


def test_the_session_names_wind_and_patches() -> None:
    patch = FrictionPatch(from_x_m=1.0, to_x_m=2.0, from_y_m=3.0, to_y_m=4.0, friction_share=0.5)
    ground = ground_of(Environment(wind_mps=10.0, wind_to_deg=90.0, friction_patches=(patch,)))
    assert (ground.wind_x_mps, ground.wind_y_mps) == (pytest.approx(0.0, abs=1e-9), 10.0)
    assert ground.patches == (Patch(1.0, 2.0, 3.0, 4.0, 0.5),)
