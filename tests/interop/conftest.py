"""A console in a graph with one node that does what it is told, for the tests of one file together."""

from collections.abc import Iterator

import pytest

from tests.interop.programs import Client, client
from tests.interop.puppets import Puppet, Served, puppet, served
from tests.interop.ros2 import domain


@pytest.fixture(scope="module")
def sides() -> Iterator[tuple[Served, Puppet]]:
    around = domain()
    with served(around) as console, puppet(around) as node:
        yield console, node


@pytest.fixture
def web(sides: tuple[Served, Puppet]) -> Iterator[Client]:
    with client(sides[0].url) as made:
        yield made


@pytest.fixture
def node(sides: tuple[Served, Puppet]) -> Puppet:
    return sides[1]
