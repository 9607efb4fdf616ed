"""The types the console speaks: the definition files shipped beside this module, laid out as ROS lays out packages.

Names, types and constants are those of ROS 2 Kilted for its common packages, and those of their ROS 2 releases for
ackermann_msgs, auv_msgs, Autoware's packages, geographic_msgs, nav2_msgs, turtlebot3_msgs and vision_msgs; rosapi is
rosbridge_suite's rosapi_msgs. Comments are left out but in simconsole_msgs, the console's own.
"""

from functools import cache
from pathlib import Path
from typing import Final

from simconsole.bridge.messages.definition import Definition
from simconsole.bridge.messages.message_registry import Registry

DEFINITIONS: Final = Path(__file__).parent / "definitions"
_KINDS: Final = ("msg", "srv", "action")


def standard_registry() -> Registry:
    """Return a new registry with the packages the console speaks; add your own definitions to it."""
    registry = Registry()
    for definition in _standard_definitions():
        registry.add_definition(definition)
    return registry


def definition_files(folder: Path) -> list[Path]:
    """Return the files `PACKAGE/msg/NAME.msg`, `PACKAGE/srv/NAME.srv` and `PACKAGE/action/NAME.action`, sorted."""
    return sorted(path for kind in _KINDS for path in folder.glob(f"*/{kind}/*.{kind}"))


@cache
def _standard_definitions() -> tuple[Definition, ...]:
    registry = Registry()
    for path in definition_files(DEFINITIONS):
        registry.add_file(path, path.read_bytes().decode())
    return tuple(registry.definition(name) for name in registry.names())
