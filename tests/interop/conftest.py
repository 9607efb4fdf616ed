"""A console in a graph with one node that does what it is told, for the tests of one file together."""

from collections.abc import Iterator, Mapping

import pytest

from tests.interop.programs import Client, client
from tests.interop.puppets import Puppet, Served, puppet, served
from tests.interop.ros2 import domain


@pytest.fixture(scope="module")
def around() -> Mapping[str, str]:
    """The environment of one graph."""
    return domain()


@pytest.fixture(scope="module")
def sides(around: Mapping[str, str]) -> Iterator[tuple[Served, Puppet]]:
    with served(around) as console, puppet(around) as node:
        yield console, node


@pytest.fixture
def web(sides: tuple[Served, Puppet]) -> Iterator[Client]:
    with client(sides[0].url) as made:
        yield made


@pytest.fixture
def node(sides: tuple[Served, Puppet]) -> Puppet:
    return sides[1]


@pytest.fixture
def other_node(around: Mapping[str, str], sides: tuple[Served, Puppet]) -> Iterator[Puppet]:
    with puppet(around, "other") as made:
        yield made
