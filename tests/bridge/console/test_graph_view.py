"""The graph's rules for names and types."""

import pytest

from simconsole.bridge.console.graph_view import Kind, full_type, why_unfit


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


@pytest.mark.parametrize(("kind", "longest"), [("topic", 247), ("service", 244), ("action", 224)])
def test_longest_names(kind: Kind, longest: int) -> None:
    folder = {"topic": "msg", "service": "srv", "action": "action"}[kind]
    assert why_unfit(kind, "/".ljust(longest, "n"), f"std_msgs/{folder}/String") == ""
    why = why_unfit(kind, "/".ljust(longest + 1, "n"), f"std_msgs/{folder}/String")
    assert f"longer than {longest} characters" in why


@pytest.mark.parametrize(
    "type_name",
    ["a/b/c/d", "a", "", "std_srvs/msg/SetBool", "std_srvs/srv/set_bool", "../srv/It", "a/srv/It\n", "A/srv/It"],
)
def test_types_of_services_that_are_none(type_name: str) -> None:
    assert "is no type such as package/srv/Name" in why_unfit("service", "/it", type_name)
    assert why_unfit("service", "/it", "a_b1/srv/It2") == ""
