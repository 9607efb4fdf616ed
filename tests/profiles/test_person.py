"""The simulated person's plan: what is refused."""

import pytest

from simconsole.profiles.files.loader import parse
from simconsole.profiles.person import PersonPlan
from simconsole.values.errors import ProfileError


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("autonomy: {}", "distance_m or time_s must be given"),
        ("cruise_kmh: 500", "5 to 130"),
        ("habits: {brake: 0}", "habits.brake"),
        ("autonmy: {time_s: 1}", "did you mean autonomy"),
        ("stop: {distance_m: .nan}", "finite"),
    ],
)
def test_plan_that_cannot_be_meant_is_refused(text: str, message: str) -> None:
    with pytest.raises(ProfileError, match=message):
        parse(text, PersonPlan, "plan.yaml")
