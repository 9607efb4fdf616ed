import json
from pathlib import Path

import pytest

from simconsole.bridge.messages import Registry, standard_registry
from simconsole.bridge.messages.definition_text import full_text, text_of
from simconsole.bridge.messages.hashes import md5, rihs01

REGISTRY = standard_registry()
# rosmsg md5 (ROS 1, Noetic) and the wheels' type descriptions (ROS 2, Kilted) say so; tests/interop/test_definitions.py
# compares all there are with real packages.
MD5 = {
    "std_msgs/String": "992ce8a1687cec8c8bd883ec73ca41d1",
    "std_msgs/Header": "2176decaecbce78abc3b96ef049fabed",
    "geometry_msgs/Twist": "9f195f881246fdfa2798d1d3eebca84a",
    "nav_msgs/Odometry": "cd5e73d190d741a2f92e81eda573aca7",
    "sensor_msgs/LaserScan": "90c7ef2dc6895d81024acba2ac42f369",
}


@pytest.mark.parametrize(("name", "known"), MD5.items())
def test_md5_of_ros1(name: str, known: str) -> None:
    assert md5(REGISTRY, name) == known


def test_every_definition_reads_back_from_its_text() -> None:
    again = Registry()
    for name in REGISTRY.names():
        again.add(name.replace("_msgs/msg/", "_msgs/"), text_of(REGISTRY.definition(name)))
    assert [again.definition(name) for name in again.names()] == [REGISTRY.definition(name) for name in again.names()]
    assert again.names() == REGISTRY.names()


def test_written_defaults_and_bounds() -> None:
    text = (
        'bool a true\nint32 b -7\nstring<=5 c "x y"\nfloat64[] d [1.0, 2.5]\nuint8[<=3] e\nbyte[2] f\nstring G=a # b\n'
    )
    registry = standard_registry()
    registry.add("demo/Written", text)
    written = text_of(registry.definition("demo/Written"))
    again = Registry()
    again.add("demo/Written", written)
    assert again.definition("demo/Written") == registry.definition("demo/Written")
    assert text_of(registry.definition("demo/Written"), ros1=True) == (
        "string G=a # b\nbool a\nint32 b\nstring c\nfloat64[] d\nuint8[] e\nbyte[2] f\n"
    )


def test_the_header_of_ros1_has_its_number() -> None:
    text = full_text(REGISTRY.with_parts("geometry_msgs/PointStamped"), ros1=True)
    assert "MSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n" in text


def test_rihs01_tells_all_that_matters_and_nothing_else() -> None:
    def hashed(text: str) -> str:
        registry = standard_registry()
        registry.add("demo/Case", text)
        return rihs01(registry, "demo/Case")

    kinds = ["", "bool", "byte", "int8", "uint8", "string", "string<=4", "wstring", "float32[3]", "float32[<=3]"]
    kinds += ["float32[]", "geometry_msgs/Point", "geometry_msgs/Point[]"]
    hashes = {hashed(f"{kind} a\n" if kind else "") for kind in kinds}
    assert len(hashes) == len(kinds)
    assert hashed("char a 7\nint32 B=3\n") == hashed("uint8 a\n")


PUBLISHED = json.loads((Path(__file__).parent / "published_hashes.json").read_text())
"""ROS 1's md5 and ROS 2's RIHS01 of what no installed package vouches for, made from the sources named there."""


@pytest.mark.parametrize("package", PUBLISHED)
def test_definitions_have_the_hashes_of_the_published_sources(package: str) -> None:
    published = {f"{package}/msg/{name}": tuple(hashes) for name, hashes in PUBLISHED[package]["types"].items()}
    ours = [name for name in REGISTRY.names() if name.startswith(f"{package}/")]
    assert {name: (md5(REGISTRY, name), rihs01(REGISTRY, name)[len("RIHS01_") :]) for name in ours} == published
