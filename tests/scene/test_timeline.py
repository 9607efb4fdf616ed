from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from simconsole.scene.plots import PLOTS
from simconsole.scene.timeline import NEEDED, Entry, Memory, Piece, piece, quaternions
from simconsole.values.signals import Event, Mode
from tests.scene.drives import CHANGES, COLUMNS, TICK_HZ, rows

COUNT = 3000
NS_PER_TICK = 4_000_000


def pieces(cuts: list[int], rate_hz: int = 50) -> list[Piece]:
    table, ticks = rows(COUNT), np.arange(1, COUNT + 1)
    memory, found = Memory(), []
    for start, end in pairwise([0, *cuts, COUNT]):
        added, memory = piece(table[start:end], COLUMNS, ticks[start:end], TICK_HZ, rate_hz, memory)
        found.append(added)
    return found


@pytest.fixture(scope="module")
def whole() -> Piece:
    (only,) = pieces([])
    return only


def test_poses_and_plots_come_at_the_scenes_rate(whole: Piece) -> None:
    assert whole.ticks.tolist() == list(range(5, COUNT + 1, 5))
    assert whole.times_ns.tolist() == [tick * NS_PER_TICK for tick in whole.ticks.tolist()]
    table = rows(COUNT)
    assert (whole.positions[:, 0] == table[4::5, COLUMNS.index("vehicle.x_m")]).all()
    assert whole.plots["plots/speed"][-1, 0] == pytest.approx(36.0)
    assert whole.plots["plots/engine"][0, 0] == pytest.approx(200.0 * 9.549296585513721)
    assert {path: values.shape[1] for path, values in whole.plots.items()} == {p.path: len(p.series) for p in PLOTS}


def test_a_rate_above_the_ticks_keeps_every_tick() -> None:
    (only,) = pieces([], rate_hz=1000)
    assert len(only.ticks) == COUNT


def test_mode_changes_keep_their_exact_tick(whole: Piece) -> None:
    lane = next(lane for lane in whole.lanes if lane.path == "lanes/mode")
    assert lane.times_ns == [tick * NS_PER_TICK for tick, _, _ in CHANGES]
    assert lane.states == ["PARKED", "MANUAL", "AUTONOMOUS", "TAKE OVER", "MANUAL"]


def test_take_over_and_gear_have_lanes(whole: Piece) -> None:
    lanes = {lane.path: lane for lane in whole.lanes}
    assert lanes["lanes/takeover"].states == ["none", "asked", "none"]
    assert lanes["controls/gear"].states == ["N", "1", "2"]
    assert lanes["controls/gear"].times_ns == [tick * NS_PER_TICK for tick in (1, 300, 900)]


def test_the_log_tells_modes_reasons_refusals_and_events_in_order(whole: Piece) -> None:
    assert [(entry.t_ns // NS_PER_TICK, entry.level, entry.text) for entry in whole.entries] == [
        (1, "INFO", "PARKED: drive started"),
        (300, "INFO", "MANUAL: driver asked"),
        (800, "WARN", "refused: brake is pressed"),
        (1003, "INFO", "AUTONOMOUS: driver asked"),
        (1501, "INFO", "event: request manual, mark"),
        (2001, "WARN", "TAKE OVER: autopilot went silent"),
        (2503, "INFO", "MANUAL: driver turned the wheel"),
    ]


@pytest.mark.parametrize("cuts", [[], [1500], [2000, 2001]])
def test_a_failed_recording_is_told_once_beside_the_other_events(cuts: list[int]) -> None:
    table, at = rows(COUNT), COLUMNS.index("events.events")
    table[2000:, at] += float(Event.RECORDING_FAILED)
    table[2100, at] += float(Event.MARK)
    memory = Memory()
    entries: list[Entry] = []
    for start, end in pairwise([0, *cuts, COUNT]):
        added, memory = piece(table[start:end], COLUMNS, np.arange(start + 1, end + 1), TICK_HZ, 50, memory)
        entries += added.entries
    found = [(entry.t_ns // NS_PER_TICK, entry.level, entry.text) for entry in entries]
    assert [entry for entry in found if entry[0] > 2000 and not entry[2].startswith(("TAKE OVER", "MANUAL"))] == [
        (2001, "ERROR", "recording failed: the drive is not kept"),
        (2101, "INFO", "event: mark"),
    ]


@pytest.mark.parametrize("cuts", [[], [1500], [2000, 2001]])
def test_traffic_that_fails_is_told_once(cuts: list[int]) -> None:
    table, memory, entries = rows(COUNT), Memory(), []
    table[2000:, COLUMNS.index("ahead.traffic_lost")] = 1.0
    for start, end in pairwise([0, *cuts, COUNT]):
        added, memory = piece(table[start:end], COLUMNS, np.arange(start + 1, end + 1), TICK_HZ, 50, memory)
        entries += [(one.t_ns // NS_PER_TICK, one.level) for one in added.entries if "traffic" in one.text]
    assert entries == [(2001, "ERROR")]


def test_the_driven_path_is_whole_and_knows_its_mode(whole: Piece) -> None:
    strips = whole.strips
    for before, after in pairwise(strips):
        assert before.t_ns < after.t_ns
        assert (before.points[-1] == after.points[0]).all()
    assert (strips[-1].points[-1] == whole.positions[-1]).all()
    length = sum(float(np.hypot(*np.diff(strip.points[:, :2], axis=0).T).sum()) for strip in strips)
    driven = float(np.hypot(*np.diff(whole.positions[:, :2], axis=0).T).sum())
    assert length == pytest.approx(driven, abs=0.1)
    changes = [strip.mode for strip in strips]
    assert [mode for index, mode in enumerate(changes) if index == 0 or changes[index - 1] != mode] == [
        Mode.MANUAL,
        Mode.AUTONOMOUS,
        Mode.TAKEOVER_REQUESTED,
        Mode.MANUAL,
    ]


def test_a_standing_car_draws_no_path() -> None:
    table = rows(290)
    added, memory = piece(table, COLUMNS, np.arange(1, 291), TICK_HZ, 50, Memory())
    assert added.strips == ()
    assert memory.open_end is not None


@pytest.mark.parametrize("cuts", [[1500], [1, 2, 3, 4], [299, 300, 301, 1002, 1003], list(range(7, COUNT, 7))])
def test_pieces_add_up_to_the_whole(whole: Piece, cuts: list[int]) -> None:
    parts = pieces(cuts)
    assert np.concatenate([part.ticks for part in parts]).tolist() == whole.ticks.tolist()
    assert (np.concatenate([part.positions for part in parts]) == whole.positions).all()
    assert [entry for part in parts for entry in part.entries] == list(whole.entries)
    for index, lane in enumerate(whole.lanes):
        assert [t for part in parts for t in part.lanes[index].times_ns] == lane.times_ns
        assert [s for part in parts for s in part.lanes[index].states] == lane.states
    strips = [strip for part in parts for strip in part.strips]
    for before, after in pairwise(strips):
        assert (before.points[-1] == after.points[0]).all()
    assert np.abs(strips[-1].points[-1] - whole.strips[-1].points[-1]).max() < 0.5


def test_ticks_may_be_missing() -> None:
    """A live reader that was too slow skips ticks: what it saw is shown, what it missed is not invented."""
    table, ticks = rows(COUNT), np.arange(1, COUNT + 1)
    keep = np.r_[0:200, 2200:COUNT]
    added, _ = piece(table[keep], COLUMNS, ticks[keep], TICK_HZ, 50, Memory())
    lane = next(lane for lane in added.lanes if lane.path == "lanes/mode")
    assert lane.states == ["PARKED", "TAKE OVER", "MANUAL"]
    assert lane.times_ns[1] == 2201 * NS_PER_TICK


def _turn(quaternion: np.ndarray, vector: tuple[float, float, float]) -> np.ndarray:
    x, y, z, w = quaternion
    axis = np.array((x, y, z))
    return np.asarray(vector + 2.0 * np.cross(axis, np.cross(axis, vector) + w * np.asarray(vector)))


def test_quaternions_turn_by_yaw_pitch_roll() -> None:
    quarter = np.array([np.pi / 2])
    zero = np.zeros(1)
    assert _turn(quaternions(quarter, zero, zero)[0], (1.0, 0.0, 0.0)) == pytest.approx((0.0, 1.0, 0.0))
    # Pitch is positive nose down, roll positive right side down (about x forward, y left).
    assert _turn(quaternions(zero, quarter, zero)[0], (1.0, 0.0, 0.0)) == pytest.approx((0.0, 0.0, -1.0))
    assert _turn(quaternions(zero, zero, quarter)[0], (0.0, 1.0, 0.0)) == pytest.approx((0.0, 0.0, 1.0))
    rng = np.random.default_rng(3)
    angles = rng.uniform(-3.0, 3.0, (3, 50))
    assert np.linalg.norm(quaternions(*angles), axis=1) == pytest.approx(np.ones(50)), "seed 3"
    both = _turn(quaternions(quarter, quarter, zero)[0], (0.0, 0.0, 1.0))
    assert both == pytest.approx((0.0, 1.0, 0.0))  # pitched nose down, then turned left


def test_the_needed_columns_are_columns_of_a_state_vector() -> None:
    assert set(NEEDED) <= set(COLUMNS)
    (only,) = pieces([])
    table = rows(COUNT)[:, [COLUMNS.index(name) for name in NEEDED]]
    thin, _ = piece(table, NEEDED, np.arange(1, COUNT + 1), TICK_HZ, 50, Memory())
    assert (thin.positions == only.positions).all()
    assert thin.entries == only.entries


def test_this_folder_has_no_picture_committed() -> None:
    assert not [path for path in Path(__file__).parent.iterdir() if path.suffix in {".png", ".rrd"}]
