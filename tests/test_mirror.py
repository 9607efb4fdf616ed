"""Each module's test lies beside its name: that of simconsole/hud/dial.py is tests/hud/test_dial.py."""

from pathlib import Path
from typing import Final

import pytest

from tests.paths import ROOT
from tests.sources import modules

ELSEWHERE: Final = {
    # They need a socket, ROS, SUMO, a viewer or processes of their own, which whole drives bring.
    "bridge/ros2/graph": "interop/test_ros2.py",
    "bridge/ros2/graph_topics": "interop/test_relay_messages.py",
    "bridge/tools/bench_peers": "bridge/tools/test_bench.py",
    "bridge/transport/picows_transport": "bridge/transport/test_interface.py",
    "bridge/transport/websockets_transport": "bridge/transport/test_interface.py",
    "evaluation/sweep/kept": "cli/sweep/test_sweep_command.py",
    "evaluation/sweep/pool_worker": "evaluation/sweep/test_worker_pool.py",
    "evaluation/sweep/task": "evaluation/sweep/test_plan.py",
    "evaluation/sweep/worker": "evaluation/sweep/test_worker_pool.py",
    "scene/viewer/rerun_view": "scene/viewer/test_export.py",
    "scene/viewer/standing": "scene/viewer/test_export.py",
    "session/fleet/company": "session/fleet/test_cars.py",
    "session/fleet/served_link": "session/fleet/test_paced_fleet.py",
    "session/fleet/shared_sumo": "session/fleet/test_cars_on_sumo.py",
    "session/fleet/sight": "session/fleet/test_cars.py",
    "session/realtime": "session/test_paced.py",
    "world/sumo_traffic/ego": "world/sumo_traffic/test_several_egos.py",
    # They hold words, bounds and fields, which others look at as a whole.
    "cli/arguments/buses": "cli/terminal/test_parser.py",
    "cli/arguments/cockpits": "cli/terminal/test_parser.py",
    "cli/arguments/driving": "cli/terminal/test_parser.py",
    "cli/arguments/recorded_drives": "cli/terminal/test_parser.py",
    "cli/arguments/tools": "cli/terminal/test_parser.py",
    "cli/new/driver_texts": "cli/new/test_texts.py",
    "cli/new/metric_texts": "cli/new/test_texts.py",
    "cli/new/platform_texts": "cli/new/test_texts.py",
    "cli/new/world_texts": "cli/new/test_texts.py",
    "control/requests/tick_context": "control/test_one_tick.py",
    "drivers/robots/nodes/ros_client": "drivers/robots/nodes/test_shared_client.py",
    "faults/switched": "faults/test_command_faults.py",
    "hud/window/ports": "hud/window/test_window_loop.py",
    "profiles/parts/chassis": "profiles/test_vehicle.py",
    "profiles/parts/ranges": "profiles/parts/test_drivetrain.py",
    "values/platform": "vehicle/test_contract.py",
    "values/signals/inputs": "test_sources.py",
    "values/signals/stages": "test_sources.py",
    "values/signals/surroundings": "test_sources.py",
    "values/version": "test_packaging.py",
}
"""Modules without a test beside their name, and the file below tests/ that tests them."""


def unmirrored(found: set[str], tests: set[str]) -> set[str]:
    """Return the modules that no test has its name from.

    Args:
        found: modules by their path below the package, without an ending; `__init__` and the like are not looked at.
        tests: test files by theirs below tests/. The part behind a module's name says what of it is tested; where the
            whole is another module's name, it is the test of that one.
    """
    named = {module for module in found if not module.rpartition("/")[2].startswith("__")}
    tested = {test.replace("/test_", "/") for test in tests}
    more = tested - named

    def has_test(module: str) -> bool:
        return module in tested or any(test.startswith(f"{module}_") for test in more)

    return {module for module in named if not has_test(module)}


def below(folder: Path, paths: list[Path]) -> set[str]:
    return {path.relative_to(folder).with_suffix("").as_posix() for path in paths}


def test_every_module_has_a_test_beside_its_name_or_is_listed() -> None:
    tests = below(ROOT / "tests", [*(ROOT / "tests").rglob("test_*.py")])
    assert unmirrored(below(ROOT / "simconsole", [*modules().values()]), tests) == set(ELSEWHERE)


def test_who_is_tested_elsewhere_says_where() -> None:
    assert [test for test in ELSEWHERE.values() if not (ROOT / "tests" / test).is_file()] == []


@pytest.mark.parametrize(
    ("tests", "without"),
    [
        ({"hud/test_dial"}, {"hud/dial_face"}),
        ({"hud/test_dial", "hud/test_dial_face_edges"}, set()),
        ({"hud/test_dial_face"}, {"hud/dial"}),
        ({"test_dial", "scene/test_dial_face"}, {"hud/dial", "hud/dial_face"}),
    ],
)
def test_finder_of_modules_without_a_test_finds_them(tests: set[str], without: set[str]) -> None:
    assert unmirrored({"hud/dial", "hud/dial_face", "hud/__init__"}, tests) == without
