from simconsole.world.course import Course
from simconsole.world.drawing import Drawing, draw
from simconsole.world.world import World


def test_drawing_is_made_once_and_only_when_it_is_asked_for(course: Course) -> None:
    made: list[Drawing] = []

    def drawn() -> Drawing:
        made.append(draw(course))
        return made[-1]

    world = World("a title", course, drawn)
    assert made == []
    assert world.drawing is world.drawing is made[0]
    assert len(made) == 1
    assert (world.title, world.route) == ("a title", course)
