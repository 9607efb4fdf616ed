"""An example of a key is what a shipped profile has there."""

import pytest

from simconsole.profiles.keys.finding import find_keys
from simconsole.profiles.keys.kinds import KINDS
from simconsole.profiles.keys.shipped_values import example_of, shipped_files


@pytest.mark.parametrize("kind", [kind for kind, file in KINDS.items() if file.shipped])
def test_every_kind_but_one_is_shipped(kind: str) -> None:
    assert shipped_files(kind)


def test_a_plan_is_no_world() -> None:
    assert {path.name for path in shipped_files("plan")} == {"urban.plan.yaml"}
    assert "urban.plan.yaml" not in {path.name for path in shipped_files("world")}


@pytest.mark.parametrize(
    ("asked", "file", "value"),
    [
        ("vehicle.steering.ratio", "vehicles/commonroad_bmw320i.yaml", 15.5),
        ("world.lane_width_m", "worlds/urban.yaml", 3.5),
        ("gearbox.driven", "vehicles/commonroad_bmw320i.yaml", "rear"),
        ("session.scenario.faults.stall_ms", "scenarios/faults/loop_stalls.yaml", None),
        ("script.points.press", "scenarios/hand_over/paused.yaml", ["autonomous"]),
    ],
)
def test_an_example_is_of_the_asked_key(asked: str, file: str, value: object) -> None:
    (key,) = find_keys(asked)
    example = example_of(key)
    assert example is not None
    assert example.file == file
    assert value is None or example.value == value


def test_an_example_is_of_the_asked_kind_of_a_section() -> None:
    """Other faults have a `seed` or a `by_ms` too."""
    for key in find_keys("session.scenario.faults.by_ms"):
        example = example_of(key)
        assert example is None or example.value > 0.0


def test_what_no_profile_sets_has_no_example() -> None:
    (key,) = find_keys("sweep.timeout_s")
    assert example_of(key) is None
