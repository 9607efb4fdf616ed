from pathlib import Path

import pytest

from simconsole.bridge.transport.message_files import MAX_BYTES, MAX_FILES, load_registry
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.errors import ProfileError


def write(folder: Path, name: str, text: str | bytes) -> Path:
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return path


def profile(folder: Path) -> BridgeProfile:
    return BridgeProfile(messages=str(folder))


def test_types_of_a_folder(tmp_path: Path) -> None:
    write(tmp_path, "own_msgs/msg/Grip.msg", "std_msgs/Header header\nfloat32[<=4] force\nFinger[] fingers\n")
    write(tmp_path, "own_msgs/msg/Finger.msg", "string<=8 name\nuint8 state 3\n")
    write(tmp_path, "own_msgs/srv/Measure.srv", "Grip grip\n---\nfloat64 force\n")
    write(tmp_path, "own_msgs/action/Close.action", "float64 force\n---\nbool held\n---\nfloat64 now\n")
    write(tmp_path, "own_msgs/README", "not one\n")
    registry = load_registry(profile(tmp_path))
    grip = registry.from_plain("own_msgs/Grip", {"force": [1.5], "fingers": [{"name": "thumb"}]})
    assert (grip.force, grip.fingers[0].state) == ([1.5], 3)
    assert registry.part("own_msgs/srv/Measure", "Request") == "own_msgs/msg/Measure_Request"
    assert registry.part("own_msgs/action/Close", "Feedback") == "own_msgs/msg/Close_Feedback"


def test_without_a_folder() -> None:
    assert "nav_msgs/msg/Odometry" in load_registry(BridgeProfile()).names()


@pytest.mark.parametrize(
    ("name", "text", "reason"),
    [
        ("own_msgs/msg/Bad.msg", "float64\n", "Bad.msg: own_msgs/msg/Bad: line 1: not a field or constant"),
        ("own_msgs/msg/Bad.msg", b"# \xff\n", "Bad.msg: 'utf-8' codec"),
        ("own_msgs/msg/Bad.msg", "#" * (MAX_BYTES + 1), f"Bad.msg: more than {MAX_BYTES} bytes"),
        ("own_msgs/msg/Bad.msg", "own_msgs/None none\n", "uses own_msgs/msg/None, which is not known here"),
        ("own_msgs/msg/Bad.msg", "Bad bad\n", "contains itself"),
        ("own_msgs/srv/Bad.srv", "float64 a\n", "Bad.srv: own_msgs/Bad: has 1 parts divided by ---, expected 2"),
        ("std_msgs/msg/String.msg", "int8 data\n", "String.msg: std_msgs/msg/String: already defined differently"),
        ("readme.txt", "", "no PACKAGE/msg/NAME.msg, .srv or .action in it"),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, name: str, text: str | bytes, reason: str) -> None:
    write(tmp_path, name, text)
    with pytest.raises(ProfileError, match=r"outputs\.bridge\.messages: ") as caught:
        load_registry(profile(tmp_path))
    assert reason in str(caught.value)


def test_too_many_files(tmp_path: Path) -> None:
    for number in range(MAX_FILES + 1):
        write(tmp_path, f"own_msgs/msg/M{number}.msg", "")
    with pytest.raises(ProfileError, match=f"{MAX_FILES + 1} files, at most {MAX_FILES}"):
        load_registry(profile(tmp_path))
