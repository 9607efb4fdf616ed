"""Bags of every kind are read alike; broken ones are one line, whatever is broken."""

import sqlite3
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest

from simconsole.recording.imports.bag import MAX_METADATA_BYTES, Bag, BagTopic
from simconsole.values.errors import RecordingError
from tests.recording.imports.bags import ACKERMANN, EPOCH_NS, JOY, Written, ackermann, joy, said, write_bag
from tests.samples import Sample

KINDS = {"mcap": "bag", "sqlite3": "bag", "ros1": "drive.bag"}
LENGTHS = (2**31 - 1, 2**32 - 1, 2**40, 2**63 - 1, 2**64 - 1)
every_kind = pytest.mark.parametrize("kind", KINDS)
TIMES_NS = [EPOCH_NS + at for at in (0, 19_000_000, 41_500_000)]


@pytest.fixture
def write(tmp_path: Path) -> Callable[..., Path]:
    def written(kind: str, start_ns: int = EPOCH_NS) -> Path:
        messages = [ackermann(at - EPOCH_NS + start_ns, frame="base_link") for at in TIMES_NS]
        messages.insert(1, joy(TIMES_NS[0] - EPOCH_NS + start_ns, [0.5, -1.0], [0, 1]))
        return write_bag(tmp_path / KINDS[kind], messages, kind)

    return written


@every_kind
def test_topics_types_times_and_values(write: Callable[..., Path], kind: str) -> None:
    bag = Bag(write(kind))
    assert set(bag.topics) == {BagTopic("/ego/drive", ACKERMANN, 3), BagTopic("/joy", JOY, 1)}
    assert bag.start_ns == EPOCH_NS
    found = list(bag.messages(["/ego/drive"]))
    assert [message.time_ns for message in found] == [0, 19_000_000, 41_500_000], "a wall clock's times from the start"
    assert found[1].plain["drive"]["steering_angle"] == 0.125
    assert found[1].plain["header"]["frame_id"] == "base_link"
    (held,) = bag.messages(["/joy"])
    assert (held.plain["axes"], held.plain["buttons"]) == ([0.5, -1.0], [0, 1])
    assert list(bag.messages(["/nothing"])) == []


@every_kind
def test_simulated_times_stay_as_they_are(write: Callable[..., Path], kind: str) -> None:
    bag = Bag(write(kind, 2_000_000_000))
    assert [message.time_ns for message in bag.messages(["/ego/drive"])] == [
        2_000_000_000,
        2_019_000_000,
        2_041_500_000,
    ]


def test_constants_of_a_type_are_no_fields(tmp_path: Path) -> None:
    lever = Written("/lever", "autoware_vehicle_msgs/msg/GearCommand", 7, {"command": 20})
    (found,) = Bag(write_bag(tmp_path / "bag", [lever])).messages(["/lever"])
    assert found.plain == {"stamp": {"sec": 0, "nanosec": 0}, "command": 20}


def test_a_bag_without_definitions_is_read_with_ours(write: Callable[..., Path]) -> None:
    """As ROS 2 Humble writes them."""
    folder = write("sqlite3")
    (file,) = folder.glob("*.db3")
    with closing(sqlite3.connect(file)) as base:
        base.executescript("DELETE FROM message_definitions;")
    with pytest.raises(RecordingError, match="cannot be read as a bag"):
        list(Bag(folder).messages(["/ego/drive"]))
    assert len(list(Bag(folder, [ACKERMANN]).messages(["/ego/drive"]))) == 3


def test_what_is_no_bag_says_so(tmp_path: Path) -> None:
    (tmp_path / "text.csv").write_text("a,b\n")
    (tmp_path / "empty.mcap").touch()
    (tmp_path / "huge").mkdir()
    with (tmp_path / "huge" / "metadata.yaml").open("wb") as file:
        file.truncate(MAX_METADATA_BYTES + 1)
    wrong = {
        "nothing.mcap": "no such file",
        "text.csv": r"a folder of rosbag2, or a file \.mcap, \.bag, \.db3",
        "empty.mcap": "cannot be read as a bag: .*empty",
        ".": r"it holds no metadata\.yaml",
        "huge": "16777217 bytes, allowed up to 16777216",
    }
    for name, said_of_it in wrong.items():
        with pytest.raises(RecordingError, match=said_of_it):
            Bag(tmp_path / name)


def spoilt(content: bytes, rng: np.random.Generator) -> bytes:
    """Cut, changed, or with a length that no file has."""
    data = bytearray(content)
    at = int(rng.integers(len(data)))
    match int(rng.integers(4)):
        case 0:
            return bytes(data[:at])
        case 1:
            for place in rng.integers(len(data), size=int(rng.integers(1, 20))):
                data[place] ^= int(rng.integers(1, 256))
        case 2:
            data[at : at + 8] = LENGTHS[int(rng.integers(len(LENGTHS)))].to_bytes(8, "little")
        case _:
            data[at:at] = rng.bytes(int(rng.integers(1, 60)))
    return bytes(data)


@every_kind
def test_a_broken_bag_is_read_or_refused_with_one_line(write: Callable[..., Path], kind: str, sample: Sample) -> None:
    path = write(kind)
    file = path if path.is_file() else next(one for one in path.iterdir() if one.suffix in (".mcap", ".db3"))
    metadata = path / "metadata.yaml"
    whole = file.read_bytes()
    rng, refused = np.random.default_rng(sample.seed), 0
    for _ in range(sample.of(100, 3000)):
        target = metadata if path.is_dir() and rng.random() < 0.2 else file
        before = target.read_bytes()
        target.write_bytes(spoilt(before, rng))
        refusal = refused_with(path)
        if refusal:
            refused += 1
            assert str(path) in refusal
            assert "\n" not in refusal
        target.write_bytes(before)
    assert file.read_bytes() == whole
    assert refused > 10


def refused_with(path: Path) -> str:
    """Read all of a bag; return why that is not possible, empty where it is."""
    try:
        bag = Bag(path)
        for _ in bag.messages([topic.name for topic in bag.topics]):
            pass
    except RecordingError as error:
        return str(error)
    return ""


def test_requests_and_commands_of_one_bag_come_in_the_order_of_their_times(tmp_path: Path) -> None:
    path = write_bag(tmp_path / "drive.bag", [said(7, "start"), ackermann(3), said(5, "mark")])
    assert [message.time_ns for message in Bag(path).messages(["/console/request", "/ego/drive"])] == [3, 5, 7]
