"""What every source file must look like."""

import ast
import re
from typing import Any, get_type_hints

import pytest

from simconsole.values import signals
from tests.paths import ROOT
from tests.sources import Facts, facts, facts_of, modules, python_files, trees

UNITS = ("_rad", "_radps", "_m", "_mps", "_mps2", "_nm", "_s", "_ticks")
UNITLESS = {
    # pedals, authority and other shares 0..1; raw axes -1..1
    *("throttle", "brake", "clutch", "handbrake", "remote_lateral", "remote_longitudinal", "shared_trade"),
    *("remote_guidance", "car_share"),
    *("person_throttle", "person_brake", "remote_throttle", "remote_brake"),
    *("ros_throttle", "ros_brake", "ecu_throttle", "ecu_brake"),
    *("wheel_axis", "throttle_axis", "brake_axis", "clutch_axis", "handbrake_axis", "hat_x", "hat_y"),
    # counts, flags and masks
    *("sequence", "refused", "refused_seen", "sequence_seen", "invalid_run", "automatic", "engine_running"),
    *("wheel_buttons", "shifter_buttons", "pressed", "edges", "events", "faults", "gate_active", "throttle_override"),
    *("wheel_motor", "ramp", "clipped", "enabled", "hands_on", "live", "ecu_events", "fresh", "invalid", "lever_fault"),
    "implausible",
    *("anti_lock_off", "traction_off", "stability_off", "gear_fault"),
    *("turn_indicators", "hazard_lights", "stalk", "hazard_switch"),
    *("red_light", "wrong_way", "off_road", "speeding", "failing_to_yield", "collision"),
    *("first_touch", "touches"),
    # places in a map's tuples, and a time in ticks since the start
    *("lane", "edge", "tick", "approach", "signal_tick", "traffic_lost"),
    # members of an enumeration
    "signal_state",
    *("kind", "mode", "reason", "refusal", "notice", "gear", "direction", "takeover_stage", "commander", "state"),
    *("restarted", "stop_steered"),
    *("wheel_validity", "throttle_validity", "brake_validity", "clutch_validity", "shifter_validity"),
    "handbrake_validity",
}  # fmt: skip


def signal_fields() -> list[tuple[str, str]]:
    classes: list[Any] = [
        value for value in vars(signals).values() if isinstance(value, type) and hasattr(value, "_fields")
    ]
    return [(record.__name__, field) for record in classes for field in record._fields]


@pytest.mark.parametrize(("record", "field"), signal_fields())
def test_every_number_of_a_tick_says_its_unit(record: str, field: str) -> None:
    assert field.endswith(UNITS) or field in UNITLESS
    assert get_type_hints(getattr(signals, record))[field] is float


def test_list_of_unitless_numbers_holds_nothing_superfluous() -> None:
    assert {field for _, field in signal_fields()} >= UNITLESS


def test_files_are_short_enough_to_read() -> None:
    lengths = {str(path.relative_to(ROOT)): len(path.read_text().splitlines()) for path in python_files()}
    assert {path: length for path, length in lengths.items() if length > 400} == {}


def test_modules_say_what_they_are() -> None:
    unsaid = (path for path in modules().values() if not re.match(r'"""\w', path.read_text()))
    assert [path for path in unsaid if not (ast.get_docstring(ast.parse(path.read_text())) or "").strip()] == []


def built_by_position(module: Facts, records: set[str], most: int = 5) -> list[str]:
    """The records that are built with more than `most` positional values; `Record(*values)` is not meant."""
    return [f"{name}, line {line}" for name, line, given in module.calls if name in records and given > most]


def test_large_records_are_built_by_keyword() -> None:
    """Nobody sees a swap of two floats."""
    known = {record for module in facts().values() for record in module.records}
    found = {name: built_by_position(module, known) for name, module in facts().items()}
    assert {name: calls for name, calls in found.items() if calls} == {}


def test_finder_of_records_built_by_position_finds_them() -> None:
    tree = ast.parse(
        "A(1, 2, 3, 4, 5, 6)\nA(1, 2, 3, 4, 5, *rest)\nA(a=1)\nB(1, 2, 3, 4, 5, 6)\nA(*rest)\nA(1, 2, 3, 4, 5, f=6)"
    )
    assert built_by_position(facts_of(tree), {"A"}) == ["A, line 1"]


def members_chosen_in_calls(tree: ast.AST) -> list[str]:
    """Calls within kernels in whose arguments a conditional expression chooses a member of an enumeration.

    Python 3.12 and later compile such a call for each branch. numba then finds a record of an integer and one of a
    number, and unifies neither.
    """
    kernels = [
        node
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef) and any("kernel" in ast.unparse(one) for one in node.decorator_list)
    ]
    arguments = [
        (call, value)
        for kernel in kernels
        for call in ast.walk(kernel)
        if isinstance(call, ast.Call)
        for value in (*call.args, *(keyword.value for keyword in call.keywords))
        if isinstance(value, ast.IfExp)
    ]
    return [
        f"{ast.unparse(call.func)}, line {value.lineno}"
        for call, value in arguments
        if any(isinstance(branch, ast.Attribute) and branch.attr.isupper() for branch in (value.body, value.orelse))
    ]


def test_kernels_compile_with_every_python() -> None:
    found = {name: members_chosen_in_calls(tree) for name, tree in trees(r"@.*kernel")}
    assert len(found) > 50
    assert {name: calls for name, calls in found.items() if calls} == {}


def test_finder_of_chosen_members_finds_them() -> None:
    kernel = "@kernel\ndef f(a, b):\n    return A(a, fault=Fault.HOT if b else 0.0, gear=a if b else 0.0)\n"
    assert members_chosen_in_calls(ast.parse(kernel)) == ["A, line 3"]
    assert members_chosen_in_calls(ast.parse(kernel.removeprefix("@kernel\n"))) == []
