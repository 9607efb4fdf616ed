"""The intersections of the shipped course."""

from simconsole.world.course import Course
from simconsole.world.drawing import Drawing


def test_lights_face_the_traffic_beside_its_stop_line(course: Course, drawn: Drawing) -> None:
    assert len(drawn.lights) == 4
    spot = next(s for s in course.world.intersections if s.signalled)
    ours = [light for light in drawn.lights if abs(course.project(*light[:2], spot.s_m, light.yaw_rad)[2]) < 0.01]
    assert len(ours) == 1
    place = course.project(*ours[0][:2], spot.s_m)
    assert 10.0 < spot.s_m - place.s_m < 20.0
    assert -3.0 < place.lateral_m < -1.75
    assert len(drawn.stop_lines) == 4 + 2  # the unsignalled side road has two
