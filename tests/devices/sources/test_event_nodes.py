"""Event devices, found by identity; what a kernel answers is shown in tests/faults and tests/devices/haptics."""

from pathlib import Path

import pytest

from simconsole.devices.sources import event_nodes
from simconsole.devices.sources.event_nodes import EVENT, READ, WRITE, effect_slots, find_node, request, stop_effects
from simconsole.values.errors import DeviceError


def test_numbers_of_requests_are_the_kernels() -> None:
    # EVIOCGID, EVIOCGEFFECTS, EVIOCRMFF of linux/input.h, as a C compiler gives them.
    assert request(READ, 0x02, 8) == 0x80084502
    assert request(READ, 0x84, 4) == 0x80044584
    assert request(WRITE, 0x81, 4) == 0x40044581
    assert EVENT.size == 24


@pytest.mark.parametrize(("writable", "word"), [(True, "written"), (False, "read")])
def test_device_that_is_not_there_is_named(
    writable: bool, word: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(event_nodes, "NODES", tmp_path / "nowhere")
    with pytest.raises(DeviceError, match=f"value none: an event device 044f:b65e that may be {word}"):
        find_node((0x044F, 0xB65E), writable=writable)


def test_file_that_is_no_device_is_passed_over_and_closed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(event_nodes, "NODES", tmp_path)
    for name in ("event0", "event1", "mouse0"):
        (tmp_path / name).write_bytes(b"")
    before = len(list(Path("/proc/self/fd").iterdir()))
    with pytest.raises(DeviceError):
        find_node((1, 2), writable=False)
    assert len(list(Path("/proc/self/fd").iterdir())) <= before


def test_device_that_may_not_be_opened_is_named_with_the_reason(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(event_nodes, "NODES", tmp_path)
    (tmp_path / "event4").mkdir()  # nobody may open a folder for writing
    with pytest.raises(DeviceError, match=f"value {tmp_path}/event4: Is a directory: an event device"):
        find_node((1, 2), writable=True)


def test_every_slot_is_told_to_stop(tmp_path: Path) -> None:
    with (tmp_path / "told").open("w+b", buffering=0) as file:
        stop_effects(file.fileno(), 3)
        content = (tmp_path / "told").read_bytes()
        assert [EVENT.unpack(part)[2:] for part in (content[:24], content[24:48], content[48:])] == [
            (0x15, slot, 0) for slot in range(3)
        ]  # fmt: skip
        with pytest.raises(OSError, match="ioctl"):
            effect_slots(file.fileno())
