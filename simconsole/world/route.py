"""The route to follow, as points: what a controller is shown."""

from typing import Final

from simconsole.profiles.world import WorldProfile
from simconsole.world.course import Course

STEP_M: Final = 2.0


def route_of(world: WorldProfile | None) -> tuple[tuple[float, float, float], ...]:
    """Return one lap of a world's course as points of x and y in m and yaw in rad; empty without a world."""
    if world is None:
        return ()
    course = Course(world)
    points = [course.at(number * STEP_M) for number in range(int(course.length_m / STEP_M) + 1)]
    return tuple((point.x_m, point.y_m, point.yaw_rad) for point in points)
