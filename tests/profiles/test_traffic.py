"""Traffic: what is refused."""

import pytest

from simconsole.profiles.files.loader import parse
from simconsole.profiles.traffic import MOST_PARKED, MOST_VEHICLES, TrafficProfile
from simconsole.values.errors import ProfileError
from simconsole.world.traffic.road_users import CAPACITY


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("vehicles: 500", "0 to 60"),
        ("seed: -1", "seed"),
        ("period_ms: 1", "10 to 200"),
        ("lead: {speeds: []}", "lead.speeds"),
        ("lead: {gap_m: 1, speeds: [{speed_kmh: 30}]}", "lead.gap_m"),
        ("vehicels: 3", "did you mean vehicles"),
    ],
)
def test_traffic_that_cannot_be_meant_is_refused(text: str, message: str) -> None:
    with pytest.raises(ProfileError, match=message):
        parse(text, TrafficProfile, "traffic.yaml")


def test_shared_memory_has_room_for_all_that_a_profile_may_ask_for() -> None:
    assert MOST_VEHICLES + MOST_PARKED + 1 <= CAPACITY
