import numpy as np
import pytest

from simconsole.drivers.robots.allocation.methods_table import MethodRow
from simconsole.drivers.robots.nodes.team_program import Methods, MissionLog, MissionVisit, RobotMission
from simconsole.evaluation.metrics.map_errors import map_errors
from simconsole.evaluation.metrics.trajectory_errors import TrajectoryErrors
from simconsole.evaluation.robots.clearances import Clearance
from simconsole.evaluation.robots.mission_result import MissionResult, RobotResult
from simconsole.world.arena.occupancy import grid_of
from simconsole.world.arena.outlines import outlines_of
from tests.world.arena.shipped_arena import arena

ERRORS = TrajectoryErrors(0.012, 0.02, 0.001, 0.001, 0.001)
CLEAR = Clearance(0.071, 0.102)
RAW = TrajectoryErrors(0.5, 1.0, 0.1, 0.01, 0.01)


def robot(name: str, collisions: int = 0) -> RobotResult:
    way = np.array([(1.0, 1.0), (2.0, 1.5), (3.0, 1.0)])
    return RobotResult(name, 6.0, 6.3, 20.0, collisions, CLEAR, ERRORS, RAW, way)


def mission(
    name: str, tour: tuple[str, ...], reached: bool = True, visited: int | None = None, failed_s: float | None = None
) -> RobotMission:
    visits = tuple(MissionVisit(target=target, reached=reached, time_s=9.0, recoveries=0) for target in tour[:visited])
    return RobotMission(name=name, planned_m=6.0, tour=tour, visits=visits, failed_s=failed_s, moments=())


def result(*robots: tuple[RobotMission, RobotResult]) -> MissionResult:
    row = MethodRow("exact, proven", 12.0, 12.0, (12.0,), (0.001,))
    methods = tuple(
        Methods(objective=name, optimum_m=12.0, rows=(row,), without_m=(13.0,) * len(robots))
        for name in ("sum", "makespan")
    )
    done, seen = zip(*robots, strict=True)
    log = MissionLog(
        ended="mission done",
        explored_s=50.0,
        shared_s=60.0,
        objective="sum",
        targets=("A", "B"),
        sharing=tuple(one.name for one in done),
        robots=done,
        methods=methods,
    )
    grid = grid_of(arena(), 0.05)
    return MissionResult(log, seen, grid, map_errors(grid, outlines_of(arena())))


GOOD = result((mission("a", ("A", "B")), robot("a")), (mission("b", ()), robot("b")))


def test_all_targets_and_no_collision_are_good() -> None:
    assert GOOD.good
    plain = GOOD.plain()
    assert plain["planned_m"] == pytest.approx(12.0)
    assert plain["driven_m"] == pytest.approx(12.6)
    assert plain["robots"][0]["tour"] == ["A", "B"]


@pytest.mark.parametrize(
    "bad",
    [
        result((mission("a", ("A", "B")), robot("a", 1))),
        result((mission("a", ("A", "B"), reached=False), robot("a"))),
        result((mission("a", ("A", "B"), visited=1), robot("a"))),
        result((mission("a", ()), robot("a"))),
        result((mission("a", ("A",)), robot("a")), (mission("b", (), failed_s=55.0), robot("b"))),
    ],
    ids=["a collision", "a target not reached", "a target not gone to", "nothing shared out", "of a robot that failed"],
)
def test_anything_less_is_not(bad: MissionResult) -> None:
    assert not bad.good


def test_the_tables_say_whose_figure_is_whose() -> None:
    text = GOOD.text()
    assert "12.76 m" in text, "the paper's own"
    assert text.count("exact, proven") == 2
    assert "without a 13.00 m, without b 13.00 m" in text
    (line,) = [line for line in text.splitlines() if line.startswith("a ")]
    assert line.split() == [
        "a",
        "A",
        "B",
        "6.00",
        "m",
        "6.30",
        "m",
        "1.2",
        "cm",
        "50.0",
        "cm",
        "0",
        "7.1",
        "cm",
        "10.2",
        "cm",
    ]


def test_the_table_says_who_failed_and_since_when_ways_count() -> None:
    text = result((mission("a", ("A", "B")), robot("a")), (mission("b", (), failed_s=55.0), robot("b"))).text()
    assert "b failed at 55.0 s; planned and driven since 60.0 s" in text
    assert "failed at" not in GOOD.text()
