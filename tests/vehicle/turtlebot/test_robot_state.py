"""What a robot keeps: every column has a name of its own."""

from simconsole.values.state_vector import PLATFORM_AT
from simconsole.vehicle.turtlebot.robot_state import OBSTACLES_AT, PARAMETERS, ROBOT


def test_columns_of_a_robot_are_told_apart_by_their_part() -> None:
    assert len(set(ROBOT.names)) == ROBOT.width
    assert ROBOT.start == PLATFORM_AT
    assert {"motion.x_m", "odometry.x_m", "scan_from.x_m", "gauges.slip_seed"} <= set(ROBOT.names)
    assert PARAMETERS.width == OBSTACLES_AT
