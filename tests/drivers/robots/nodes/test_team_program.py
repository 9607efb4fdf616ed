import pytest

from simconsole.drivers.robots.allocation.exact import enumerated
from simconsole.drivers.robots.allocation.problem import Objective, problem_of
from simconsole.drivers.robots.nodes import program
from simconsole.drivers.robots.nodes.fleet_program import Robot
from simconsole.drivers.robots.nodes.team_program import RUNS, methods
from simconsole.values.errors import ProfileError
from simconsole.values.platform import Pose

PROBLEM = problem_of([(0.0, 0.0), (5.0, 0.0)], [(1.0, 1.0), (4.0, 2.0), (2.0, 3.0)])
NOWHERE = ("--url", "ws://127.0.0.1:9", "--wait", "0.1", "--arena", "arena")


@pytest.mark.parametrize("objective", Objective)
def test_all_methods_stand_beside_the_optimum(objective: Objective) -> None:
    found = methods(PROBLEM, objective)
    best = enumerated(PROBLEM, objective).cost
    assert found.optimum_m == pytest.approx(best)
    assert {row.method for row in found.rows} == {"exact, proven", "auction", "genetic, annealed"}
    assert all(len(row.costs_m) == len(row.times_s) == RUNS for row in found.rows)
    assert all(row.best_m >= best - 1e-9 for row in found.rows)
    without = [enumerated(PROBLEM.without(robot), objective).cost for robot in (0, 1)]
    assert found.without_m == pytest.approx(without)
    assert min(found.without_m) >= best


def test_a_robot_is_namespace_vehicle_and_start() -> None:
    words = ["team", *NOWHERE, "--robot", "/a=turtlebot3_waffle@1,2,0"]
    ((name, vehicle, robot),) = program.parser().parse_args(words).robot
    assert (name, vehicle, robot) == ("a", "turtlebot3_waffle", Robot("/a", Pose(1.0, 2.0, 0.0)))


@pytest.mark.parametrize("text", ["a=turtlebot3_burger@0,0,0", "/a=@0,0,0", "/a", "/a=turtlebot3_burger@0,0"])
def test_what_is_no_robot_is_refused(text: str) -> None:
    with pytest.raises(SystemExit):
        program.parser().parse_args(["team", *NOWHERE, "--robot", text])


def test_a_car_is_no_robot_of_a_team(capsys: pytest.CaptureFixture[str]) -> None:
    assert program.main(["team", *NOWHERE, "--robot", "/a=hatchback@0,0,0"]) == ProfileError.exit_code
    assert "hatchback" in capsys.readouterr().err
