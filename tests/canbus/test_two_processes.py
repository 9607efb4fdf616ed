"""The console and an ECU in two processes that share nothing but CAN frames, over multicast on loopback."""

import contextlib
import signal
import socket
import subprocess
from collections.abc import Iterator
from pathlib import Path

from simconsole.canbus.bus.multicast import LoopbackBus
from simconsole.canbus.bus.port import CanPort, read_log
from simconsole.canbus.codec import ECU, Codec
from simconsole.profiles.can import CanProfile
from simconsole.profiles.files.loader import to_text
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.session.resolution import load_session, override
from simconsole.values.signals import Mode, RemoteKind
from simconsole.values.state_vector import LAYOUT
from tests.canbus.programs import results, running
from tests.patience import PATIENCE_S, wait_until

DRIVE_S = 5.0


@contextlib.contextmanager
def sending(port: int, codec: Codec, *words: str) -> Iterator["subprocess.Popen[str]"]:
    """An ECU that is heard on the bus already."""
    listening = CanPort(CanProfile(port=port, log=()), frozenset(), codec.ids(ECU))
    try:
        with running("can", "send", "--port", str(port), *words) as ecu:
            wait_until(lambda: listening.receive(0.0) is not None or ecu.poll() is not None, "the first frame")
            yield ecu
    finally:
        listening.close()


def test_ecu_drives_the_car_by_can_alone(port: int, codec: Codec, tmp_path: Path) -> None:
    session = override(
        load_session("can"),
        scenario={"duration_s": DRIVE_S},
        outputs={"can": {"port": port, "log": ["blf", "candump"]}},
    )
    (tmp_path / "can.yaml").write_text(to_text(session))
    bundle = tmp_path / "bundle"
    with (
        sending(port, codec, "--engage", "--hold", "4", "--road-wheel-deg", "5") as ecu,
        running("drive", str(tmp_path / "can.yaml"), "--out", str(bundle)) as drive,
    ):
        driven = results(drive)
        ecu.send_signal(signal.SIGINT)
        said = results(ecu)
    assert Mode.AUTONOMOUS in said["modes"]
    rows = open_bundle(bundle).log.table().vectors
    autonomous = rows[:, LAYOUT.arbitration.start] == Mode.AUTONOMOUS
    assert autonomous.any()
    assert not rows[: autonomous.argmax(), LAYOUT.vehicle.start + 6].any(), "it stood until the ECU had it"
    assert 1.0 < rows[:, LAYOUT.vehicle.start + 6].max() < 4.5
    assert rows[-1, LAYOUT.vehicle.start + 3] > 0.02, "it turned left"
    accepted = rows[:, LAYOUT.ecu.at("sequence")]
    assert accepted[-1] > 50
    assert set(rows[accepted > 0, LAYOUT.ecu.start]) == {float(RemoteKind.ACCELERATION)}
    assert driven["can"]["node"]["refused"] == 0
    frames = {suffix: read_log(bundle / f"can.{suffix}") for suffix in ("blf", "log")}
    assert [frame for _, frame in frames["blf"]] == [frame for _, frame in frames["log"]]
    ids = {frame.can_id for _, frame in frames["blf"]}
    assert ids == {0x100, 0x101, 0x102, 0x103, 0x110, 0x111, 0x112, 0x120, 0x200}
    assert {"can.blf", "can.log"} <= set(open_bundle(bundle).manifest.files)


def test_bus_that_is_not_there_refuses_the_drive(tmp_path: Path) -> None:
    session = override(load_session("can"), outputs={"can": {"interface": "socketcan", "channel": "can97"}})
    (tmp_path / "can.yaml").write_text(to_text(session))
    with running("drive", str(tmp_path / "can.yaml"), "--out", str(tmp_path / "bundle")) as drive:
        _, err = drive.communicate(timeout=PATIENCE_S)
    assert drive.returncode == 2
    first, *_, last = err.splitlines()
    assert first.startswith("simconsole worker: CAN socketcan can97: cannot be opened")
    assert last == "simconsole drive: the CAN bus is not open; the worker's own message stands above"


def test_frames_stay_on_this_machine(port: int) -> None:
    """The group is joined on loopback only: what comes in on another interface is another group's business."""
    can_port = CanPort(CanProfile(port=port), frozenset({0x100}), frozenset({0x200}))
    bus = can_port._bus
    assert isinstance(bus, LoopbackBus)
    same = bus._out
    assert same.getsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL) == 0
    assert same.getsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, 4) == socket.inet_aton("127.0.0.1")
    members = [
        line.split()
        for line in Path("/proc/net/igmp").read_text().splitlines()  # group addresses under each interface
    ]
    interface, found = "", set()
    for words in members:
        if ":" in words[:3]:
            interface = words[1]
        elif words[0] == socket.inet_aton("239.74.163.2")[::-1].hex().upper():
            found.add(interface)
    can_port.close()
    assert found == {"lo"}
