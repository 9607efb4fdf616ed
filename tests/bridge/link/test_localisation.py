import math

import numpy as np
import pytest

from simconsole.bridge.link.localisation import Localisation, covariances
from simconsole.profiles.link import LinkProfile, LocalisationProfile
from simconsole.values.signals import VehicleState
from tests.samples import Sample

TICK_HZ = 250
STANDING = VehicleState(*(0.0,) * len(VehicleState._fields))


def measured(profile: LinkProfile, ticks: range) -> np.ndarray:
    localisation = Localisation(profile)
    return np.array([localisation.measure(STANDING, tick, TICK_HZ) for tick in ticks])


def test_a_perfect_localisation_tells_the_truth() -> None:
    localisation = Localisation(LinkProfile())
    assert localisation.is_perfect
    assert localisation.measure(STANDING, 5, TICK_HZ) is STANDING


def test_each_error_has_its_own_size_and_nothing_else_changes(sample: Sample) -> None:
    errors = LocalisationProfile(
        position_noise_m=0.02,
        yaw_noise_deg=0.2,
        speed_noise_mps=0.05,
        yaw_rate_noise_degps=0.1,
        accel_noise_mps2=0.03,
    )
    seen = measured(LinkProfile(seed=sample.seed, localisation=errors), range(5, 20_000, 5))
    expected = {
        "x_m": 0.02,
        "y_m": 0.02,
        "yaw_rad": math.radians(0.2),
        "vx_mps": 0.05,
        "yaw_rate_radps": math.radians(0.1),
        "ax_mps2": 0.03,
        "ay_mps2": 0.03,
    }
    for at, field in enumerate(VehicleState._fields):
        assert seen[:, at].std() == pytest.approx(expected.get(field, 0.0), rel=0.1)


def test_a_drift_is_slow_begins_at_nothing_and_reaches_its_size(sample: Sample) -> None:
    errors = LocalisationProfile(position_drift_m=0.5, yaw_drift_deg=1.0, drift_time_s=10.0)
    seen = measured(LinkProfile(seed=sample.seed, localisation=errors), range(0, sample.of(300_000, 1_000_000), 25))
    x, yaw = seen[:, 0], seen[:, VehicleState._fields.index("yaw_rad")]
    assert x[0] == 0.0
    assert np.abs(np.diff(x)).max() <= 12 * 0.5 * 1.5 / 10.0 * 25 / TICK_HZ  # from one six-fold value to the other
    assert x[2000::100].std() == pytest.approx(0.5, rel=0.25)
    assert yaw[2000::100].std() == pytest.approx(math.radians(1.0), rel=0.25)


def test_covariances_are_those_of_the_errors() -> None:
    errors = LocalisationProfile(position_noise_m=0.03, position_drift_m=0.04, yaw_noise_deg=1.0, speed_noise_mps=0.1)
    pose, twist = covariances(errors)
    assert pose[0] == pose[7] == pytest.approx(0.05**2)
    assert pose[35] == pytest.approx(math.radians(1.0) ** 2)
    assert twist[0] == pytest.approx(0.01)
    assert sum(map(bool, (*pose, *twist))) == 4
