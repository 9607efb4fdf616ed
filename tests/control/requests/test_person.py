import math

import pytest

from simconsole.control.requests.control_settings import ControlSettings
from simconsole.control.requests.person import mask, person_of
from simconsole.values.signals import DriverInput, Validity

LIVE = float(Validity.LIVE)
DRIVER = DriverInput(*(0.0,) * len(DriverInput._fields))._replace(
    wheel_validity=LIVE, throttle_validity=LIVE, brake_validity=LIVE, hand_wheel_rad=1.5, throttle=0.3
)


def test_the_persons_request(control: ControlSettings) -> None:
    assert person_of(DRIVER, 0.2, control) == pytest.approx((1.0, 1.0, 0.1, 0.3, 0.0, 0.3))
    assert person_of(DRIVER._replace(brake=0.05), 0.2, control)[3:] == (0.0, 0.05, 0.3)
    assert person_of(DRIVER._replace(brake=0.049), 0.2, control)[3:] == (0.3, 0.049, 0.3)
    assert person_of(DRIVER._replace(hand_wheel_rad=-99.0), 0.2, control).road_wheel_rad == -0.6
    assert person_of(DRIVER._replace(throttle=1.0), 0.2, control)[3:] == (1.0, 0.0, 1.0)
    assert person_of(DRIVER._replace(brake=1.0), 0.2, control)[3:] == (0.0, 1.0, 0.3)


@pytest.mark.parametrize("name", ["wheel_validity", "throttle_validity", "brake_validity"])
def test_each_of_wheel_and_pedals_is_needed(name: str, control: ControlSettings) -> None:
    person = person_of(DRIVER._replace(**{name: float(Validity.STALE)}), 0.2, control)
    assert person.trusted == 0.0
    assert person.wheel_trusted == (0.0 if name == "wheel_validity" else 1.0)
    assert person.road_wheel_rad == pytest.approx(0.2 if name == "wheel_validity" else 0.1)


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_what_is_no_number_commands_nothing(bad: float, control: ControlSettings) -> None:
    assert person_of(DRIVER._replace(hand_wheel_rad=bad), 0.2, control)[:3] == (0.0, 0.0, 0.2)
    assert person_of(DRIVER._replace(throttle=bad), 0.2, control)[:1] == (0.0,)
    assert person_of(DRIVER._replace(throttle=bad), 0.2, control).throttle == 0.0
    assert person_of(DRIVER._replace(brake=bad), 0.2, control)[:1] == (0.0,)
    assert person_of(DRIVER._replace(brake=bad), 0.2, control).brake == 0.0


@pytest.mark.parametrize(
    ("stored", "bits"),
    [(0.0, 0), (0.9, 0), (1.0, 1), (5.0, 5), (2147483647.0, 2147483647), (2147483648.0, 0), (-1.0, 0)],
)
def test_masks(stored: float, bits: int) -> None:
    assert mask(stored) == bits


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_a_mask_that_is_no_number_is_empty(bad: float) -> None:
    assert mask(bad) == 0
