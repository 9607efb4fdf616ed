"""Endpoints of a node made by hand."""

from typing import Any

from simconsole.bridge.ros2.endpoints import REPORTED_ATTEMPTS, RETRY_UPDATES, Endpoints


class Node:
    """What is asked of it, in order; it cannot make what is in `broken`, nor end at once what is in `busy`."""

    def __init__(self) -> None:
        self.did: list[tuple[str, str]] = []
        self.broken: set[str] = set()
        self.busy: set[str] = set()
        self.reports: list[tuple[str, str]] = []
        self.endpoints = Endpoints(self.make, self.end, lambda name, why: self.reports.append((name, why)))

    def make(self, name: str, how: Any) -> str:
        self.did.append(("make", f"{name} {how}"))
        if name in self.broken:
            raise RuntimeError("it cannot be")
        return name

    def end(self, endpoint: str) -> bool:
        if endpoint in self.busy:
            return False
        self.did.append(("end", endpoint))
        if endpoint in self.broken:
            raise RuntimeError("it cannot end")
        return True

    def update(self, **wanted: str) -> None:
        self.endpoints.retire(wanted)
        self.endpoints.create(wanted)


def test_endpoints_follow_what_is_wanted() -> None:
    node = Node()
    node.update(a="one", b="two")
    node.update(a="one", b="three")
    node.update(b="three")
    assert node.did == [("make", "a one"), ("make", "b two"), ("end", "b"), ("make", "b three"), ("end", "a")]
    assert node.endpoints.find("b") == ("three", "b")
    assert ("a" in node.endpoints, len(node.endpoints)) == (False, 1)


def test_a_new_one_waits_for_the_end_of_the_old() -> None:
    node = Node()
    node.update(a="one")
    node.busy.add("a")
    node.update(a="two")
    assert (node.endpoints.find("a"), "a" in node.endpoints) == (None, True)
    node.busy.clear()
    node.update(a="two")
    assert node.did == [("make", "a one"), ("end", "a"), ("make", "a two")]


def test_one_that_fails_stops_no_other_and_is_tried_again() -> None:
    node = Node()
    node.broken.add("a")
    for _ in range(REPORTED_ATTEMPTS + 1):
        node.update(a="one", b="two")
    assert node.endpoints.find("b") == ("two", "b")
    assert node.reports == [("a", "it cannot be")]
    node.broken.clear()
    for _ in range(RETRY_UPDATES):
        node.update(a="one", b="two")
    assert node.endpoints.find("a") == ("one", "a")
    assert node.reports == [("a", "it cannot be"), ("a", "")]


def test_what_is_no_longer_wanted_is_no_longer_missing() -> None:
    node = Node()
    node.broken.add("a")
    for _ in range(REPORTED_ATTEMPTS):
        node.update(a="one")
    node.update()
    assert node.reports == [("a", "it cannot be"), ("a", "")]


def test_one_that_cannot_end_is_forgotten() -> None:
    node = Node()
    node.update(a="one", b="two")
    node.broken.add("a")
    node.update()
    assert len(node.endpoints) == 0
    assert node.did[-1] == ("end", "b")
