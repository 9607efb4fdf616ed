"""Holds of a second, taken without a key: what is new counts, what was taken before does not."""

import pytest

from simconsole.devices.calibration.hands_free import HeldStill, Readings
from simconsole.devices.calibration.input_detection import Reading
from simconsole.profiles.device import DeviceKey

RATE_HZ = 100
PAD = DeviceKey(1, 2)


def held(wheel: float = 0.0, throttle: float = 1.0, brake: float = 1.0, buttons: int = 0) -> Readings:
    return {PAD: Reading((wheel, throttle, brake), buttons)}


def taken_after(holds: HeldStill, readings: Readings, seconds: float = 3.0, at_rest: bool = False) -> float | None:
    """After how many seconds of holding this it is taken; None: not."""
    for tick in range(1, round(seconds * RATE_HZ) + 1):
        if holds.add(readings, at_rest=at_rest):
            return tick / RATE_HZ
    return None


@pytest.fixture
def holds() -> HeldStill:
    fresh = HeldStill(RATE_HZ)
    fresh.begin()
    assert taken_after(fresh, held(), at_rest=True) == 1.0
    fresh.begin()
    return fresh


def test_a_hold_is_taken_after_a_second_and_rest_is_not(holds: HeldStill) -> None:
    assert taken_after(holds, held()) is None
    assert taken_after(holds, held(throttle=-1.0)) == 1.0


def test_what_moves_is_not_taken(holds: HeldStill) -> None:
    for tick in range(300):
        assert not holds.add(held(throttle=1.0 - 0.006 * tick), at_rest=False)


def test_the_last_hold_is_not_taken_for_the_next_step(holds: HeldStill) -> None:
    assert taken_after(holds, held(throttle=-1.0)) == 1.0
    holds.begin()
    assert taken_after(holds, held(throttle=-1.0)) is None
    assert taken_after(holds, held(brake=-1.0)) == 1.0


def test_the_same_hold_counts_again_after_hands_off(holds: HeldStill) -> None:
    """A step that failed is repeated: the person lets go and does the same again."""
    assert taken_after(holds, held(buttons=4)) == 1.0
    holds.begin()
    assert taken_after(holds, held(buttons=4)) is None
    assert taken_after(holds, held()) is None
    assert taken_after(holds, held(buttons=4)) == 1.0
