"""Every definition that a real package exists for here, against that package: RIHS01 of ROS 2, md5 of ROS 1."""

import json
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from simconsole.bridge.messages import standard_registry
from simconsole.bridge.messages.hashes import md5, rihs01
from tests.interop.ros1_packages import PYTHON as PYTHON1
from tests.interop.ros2 import PYTHON as PYTHON2
from tests.interop.ros2 import needs_ros2

REGISTRY = standard_registry()
PACKAGES = ("std_msgs", "geometry_msgs", "sensor_msgs", "nav_msgs", "rosgraph_msgs", "diagnostic_msgs", "tf2_msgs")
# Types whose fields or constants ROS 2 has changed; the console has ROS 2's.
CHANGED = {f"sensor_msgs/{name}" for name in ("BatteryState", "CameraInfo", "NavSatFix", "NavSatStatus", "Range")}


@needs_ros2
def test_all_definitions_are_those_of_ros2(record_property: Callable[[str, object], None]) -> None:
    share = Path(PYTHON2).parents[1] / "share"
    published: dict[str, str] = {}
    for path in share.glob("*/msg/*.json"):
        described = json.loads(path.read_text())
        published |= {entry["type_name"]: entry["hash_string"] for entry in described["type_hashes"]}
    known = [name for name in REGISTRY.names() if name in published]
    assert {name for name in known if rihs01(REGISTRY, name) != published[name]} == set()
    packages = {name.partition("/")[0] for name in published} & {name.partition("/")[0] for name in REGISTRY.names()}
    packages -= {"rcl_interfaces"}  # of which the console speaks the log and the parameters' services only
    missing = [name for name in published if name.partition("/")[0] in packages and name not in known]
    assert missing == []
    assert len(known) > 100
    record_property("definitions", f"{len(known)} have the hash of ROS 2's own package")


LIST = """
import importlib, json, sys
found = {}
for package in sys.argv[1:]:
    try:
        messages = importlib.import_module(package + ".msg")
    except ImportError:
        continue
    for name in dir(messages):
        kind = getattr(messages, name)
        if hasattr(kind, "_md5sum"):
            found[package + "/" + name] = kind._md5sum
print(json.dumps(found))
"""


@pytest.mark.skipif(not Path("/usr/bin/rosmaster").exists(), reason="no ROS 1: system-packages.txt")
def test_definitions_are_those_of_ros1_where_ros2_has_kept_them() -> None:
    done = subprocess.run([PYTHON1, "-c", LIST, *PACKAGES], capture_output=True, text=True, check=True)
    published: dict[str, str] = json.loads(done.stdout)
    names = {name.replace("/msg/", "/") for name in REGISTRY.names()}
    both = sorted(names & published.keys())
    changed = {name for name in both if md5(REGISTRY, name) != published[name]}
    assert changed == CHANGED
    assert len(both) > 90
