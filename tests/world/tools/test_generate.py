from pathlib import Path

import pytest

from simconsole.profiles.files.loader import find
from simconsole.profiles.world import CourseProfile
from simconsole.values.platform import Pose
from simconsole.world.path_geometry import Piece, travel
from simconsole.world.tools.generate import main

PLAN = Path(find("worlds", "urban")).with_name("urban.plan.yaml")


def test_regenerating_gives_equal_bytes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    target = tmp_path / "urban.yaml"
    assert main([str(PLAN), str(target)]) == 0
    assert target.read_bytes() == PLAN.with_name("urban.yaml").read_bytes()
    assert "2600.0 m" in capsys.readouterr().out


def test_bad_plan_is_one_line_and_exit_2(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    plan = tmp_path / "bad.yaml"
    plan.write_text(PLAN.read_text().replace("length_m: 2600", "length_m: 900"))
    assert main([str(plan), str(tmp_path / "out.yaml")]) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert "bad.yaml: elements: free straights" in error
    assert not (tmp_path / "out.yaml").exists()


def test_unwritable_target_is_one_line_and_exit_2(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([str(PLAN), str(tmp_path / "no" / "out.yaml")]) == 2
    assert "a folder that can be written to" in capsys.readouterr().err


def test_usage(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 2
    assert "usage" in capsys.readouterr().err


def test_urban_is_a_closed_loop_of_2600_m(urban: CourseProfile) -> None:
    pose, s = Pose(0.0, 0.0, 0.0), 0.0
    for part in urban.path:
        assert part.s_m == pytest.approx(s, abs=1e-7)
        assert (part.x_m, part.y_m, part.yaw_rad) == pytest.approx(pose, abs=1e-7)
        start = Pose(part.x_m, part.y_m, part.yaw_rad)
        pose = travel(start, Piece(part.length_m, part.curvature_start_1pm, part.curvature_end_1pm))
        s += part.length_m
    assert (pose.x_m, pose.y_m) == pytest.approx((0.0, 0.0), abs=1e-6)
    assert pose.yaw_rad == pytest.approx(6.283185307179586, abs=1e-9)
    assert s == pytest.approx(urban.length_m, abs=1e-7)
    assert abs(urban.length_m - 2600.0) <= 10.0


def test_urban_curvature_is_continuous(urban: CourseProfile) -> None:
    for before, after in zip(urban.path, (*urban.path[1:], urban.path[0]), strict=True):
        assert before.curvature_end_1pm == pytest.approx(after.curvature_start_1pm, abs=1e-12)


def test_urban_has_the_ingredients_of_the_issue(urban: CourseProfile) -> None:
    radii = [1.0 / abs(part.curvature_start_1pm) for part in urban.path if part.kind == "arc"]
    corners = [
        part for part in urban.path if part.kind == "arc" and 1 / 15.01 < abs(part.curvature_start_1pm) < 1 / 11.9
    ]
    assert len(corners) == 4
    for corner in corners:  # ramps included, each turns a quarter
        index = urban.path.index(corner)
        assert abs(urban.path[index + 2].yaw_rad - urban.path[index - 1].yaw_rad) == pytest.approx(1.5707963, abs=1e-6)
    ring = [radius for radius in radii if 17.9 < radius < 18.1]
    assert len(ring) == len(urban.roundabouts) == 1
    others = [radius for radius in radii if radius > 18.1]
    assert {round(radius) for radius in others} == {25, 40, 45, 50, 60, 70, 80, 100}
    assert any(spot.signalled for spot in urban.intersections)
    assert len(urban.crossings) >= 3
    assert urban.speed_limit_kmh == 50.0


def test_urban_starts_on_a_long_straight(urban: CourseProfile) -> None:
    first, last = urban.path[0], urban.path[-1]
    assert (first.kind, last.kind) == ("line", "line")
    assert (first.x_m, first.y_m, first.yaw_rad) == (0.0, 0.0, 0.0)
    assert first.length_m >= 250.0
