import pytest

from simconsole.profiles.files.loader import load
from simconsole.profiles.world import CourseProfile
from simconsole.world.course import Course
from simconsole.world.drawing import Drawing, draw


@pytest.fixture(scope="session")
def urban() -> CourseProfile:
    return load("worlds", "urban", CourseProfile)


@pytest.fixture(scope="session")
def course(urban: CourseProfile) -> Course:
    return Course(urban)


@pytest.fixture(scope="session")
def drawn(course: Course) -> Drawing:
    return draw(course)
