"""Force through evdev where there is none; with a device see test_sdl_haptics.py."""

from pathlib import Path

import pytest

from simconsole.devices.haptics.evdev_haptics import open_evdev
from simconsole.devices.sources import event_nodes
from simconsole.profiles.force_feedback import ForceFeedback

FORCE = ForceFeedback(max_torque_nm=4.0)


def test_no_event_device_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(event_nodes, "NODES", tmp_path)
    assert "an event device 044f:b65e that may be written" in open_evdev((0x044F, 0xB65E), FORCE).capability.name
    (tmp_path / "event3").write_bytes(b"")  # neither the identity nor a device
    port = open_evdev((0x044F, 0xB65E), FORCE)
    assert not port.capability.constant
    port.write(1.0)
    port.close()
