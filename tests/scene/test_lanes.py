import numpy as np

from simconsole.scene.lanes import LANE_COLUMNS, LANES, lane_changes, takeover_label
from simconsole.values.signals import Validity
from tests.scene.drives import COLUMNS, rows


def table(count: int) -> dict[str, np.ndarray]:
    drive = rows(count)
    return {name: drive[:, COLUMNS.index(name)] for name in LANE_COLUMNS}


def test_a_lane_tells_its_first_state_and_each_change() -> None:
    seen = table(4)
    seen["driver.wheel_validity"] = np.array([Validity.UNKNOWN, Validity.LIVE, Validity.LIVE, Validity.LOST], float)
    times = np.array([10, 20, 30, 40])
    lanes = {lane.path: lane for lane in lane_changes(seen, times, None)}
    assert set(lanes) == {kind.path for kind in LANES}
    assert lanes["health/wheel"].times_ns == [10, 20, 40]
    assert lanes["health/wheel"].states == ["not seen yet", "live", "lost"]
    assert lanes["controls/hazard_lights"].states == ["off"]


def test_what_a_piece_before_has_told_is_not_told_again() -> None:
    seen = table(2)
    before = {name: float(values[0]) for name, values in seen.items()}
    assert all(not lane.times_ns for lane in lane_changes(seen, np.array([1, 2]), before))


def test_a_robot_has_no_lane_of_what_it_does_not_have() -> None:
    paths = {lane.path for lane in lane_changes(table(2), np.array([1, 2]), None, is_robot=True)}
    assert {kind.path for kind in LANES} - paths == {
        "controls/gear",
        "controls/indicators",
        "controls/hazard_lights",
        "health/shifter",
    }


def test_every_label_of_a_state_has_its_colour() -> None:
    kinds = {kind.path: kind for kind in LANES}
    for path, value in (("lanes/mode", 3.0), ("lanes/takeover", 2.0), ("health/brake", 4.0), ("controls/gear", -1.0)):
        assert kinds[path].label(value) in kinds[path].colours


def test_an_unknown_stage_names_itself() -> None:
    assert takeover_label(7.0) == "7"
