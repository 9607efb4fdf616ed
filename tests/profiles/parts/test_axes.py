import pytest

from simconsole.profiles.parts.axes import MIN_TRAVEL_RAW, PedalAxis, WheelAxis
from tests.profiles.refused import refusal


@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_a_pedal_has_travel_whichever_way_its_raw_value_grows(direction: float) -> None:
    assert PedalAxis(axis=0, rest_raw=0.0, full_raw=direction * MIN_TRAVEL_RAW).dead_zone < MIN_TRAVEL_RAW
    with pytest.raises(ValueError, match=r"^rest_raw 0\.0 and full_raw -?0\.19 must lie at least 0\.2 apart$"):
        PedalAxis(axis=0, rest_raw=0.0, full_raw=direction * 0.19)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("axis: 32\nlock_to_lock_deg: 900", "axis: value 32: "),
        ("axis: 0\nlock_to_lock_deg: 900\ncentre_raw: 0.51", "centre_raw: value 0.51: "),
        ("axis: 0\nlock_to_lock_deg: 900\ncurve: 0", "curve: value 0: "),
        ("axis: 0\nlock_to_lock_deg: 900\nassistance: {full_s: 0}", "assistance.full_s: value 0: "),
    ],
)
def test_a_wheel_that_cannot_be_meant_is_refused(text: str, told: str) -> None:
    assert told in refusal(text, WheelAxis)
