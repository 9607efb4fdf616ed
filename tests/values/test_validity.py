import math

import pytest

from simconsole.values.signals import Validity
from simconsole.values.validity import is_trusted, wilful_torque


def test_only_armed_and_live_inputs_command() -> None:
    assert [is_trusted(float(validity)) for validity in Validity] == [False, True, True, False, False]
    assert not is_trusted(1.5)


def test_torque_by_which_a_fast_wheel_turns_resting_hands_is_no_wish() -> None:
    assert wilful_torque(1.45, -36.0) == pytest.approx(0.73)
    assert wilful_torque(-1.45, 36.0) == pytest.approx(0.73)


@pytest.mark.parametrize("human_nm", [3.0, -3.0])
@pytest.mark.parametrize("hand_wheel_radps2", [0.0, 60.0])
def test_a_push_counts_whole_however_fast_it_turns_the_wheel(human_nm: float, hand_wheel_radps2: float) -> None:
    assert wilful_torque(human_nm, math.copysign(hand_wheel_radps2, human_nm)) == 3.0


def test_a_wheel_that_nobody_touches_is_not_pulled_and_an_unknown_motion_explains_nothing() -> None:
    assert wilful_torque(0.0, 100.0) == 0.0
    assert wilful_torque(2.0, math.nan) == 2.0
