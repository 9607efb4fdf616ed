"""The graph's rules for names and types."""

import pytest

from simconsole.bridge.console.graph_view import MAX_ACTION_NAME, MAX_NAME, Kind, full_type, why_unfit


@pytest.mark.parametrize(
    ("name", "kind", "full"),
    [
        ("std_srvs/SetBool", "service", "std_srvs/srv/SetBool"),
        ("std_srvs/srv/SetBool", "service", "std_srvs/srv/SetBool"),
        ("test_msgs/Fibonacci", "action", "test_msgs/action/Fibonacci"),
        ("a/b/c/d", "service", "a/b/c/d"),
        ("a", "service", "a"),
    ],
)
def test_full_type(name: str, kind: Kind, full: str) -> None:
    assert full_type(name, kind) == full


@pytest.mark.parametrize(
    ("kind", "length", "fits"),
    [
        ("topic", MAX_NAME, True),
        ("topic", MAX_NAME + 1, False),
        ("service", MAX_NAME + 1, False),
        ("action", MAX_ACTION_NAME, True),
        ("action", MAX_ACTION_NAME + 1, False),
    ],
)
def test_longest_names(kind: Kind, length: int, fits: bool) -> None:
    folder = {"topic": "msg", "service": "srv", "action": "action"}[kind]
    why = why_unfit(kind, "/" + "n" * (length - 1), f"std_msgs/{folder}/String")
    assert (why == "") is fits
    assert fits or f"longer than {length - 1} characters" in why


@pytest.mark.parametrize(
    "type_name",
    ["a/b/c/d", "a", "", "std_srvs/msg/SetBool", "std_srvs/srv/set_bool", "../srv/It", "a/srv/It\n", "A/srv/It"],
)
def test_types_of_services_that_are_none(type_name: str) -> None:
    assert "is no type such as package/srv/Name" in why_unfit("service", "/it", type_name)
    assert why_unfit("service", "/it", "a_b1/srv/It2") == ""
