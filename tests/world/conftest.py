import pytest

from simconsole.profiles.files.loader import load
from simconsole.profiles.world import WorldProfile
from simconsole.world.course import Course
from simconsole.world.drawing import Drawing, draw


@pytest.fixture(scope="session")
def urban() -> WorldProfile:
    return load("worlds", "urban", WorldProfile)


@pytest.fixture(scope="session")
def course(urban: WorldProfile) -> Course:
    return Course(urban)


@pytest.fixture(scope="session")
def drawn(course: Course) -> Drawing:
    return draw(course)
