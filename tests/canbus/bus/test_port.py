"""The port on python-can's virtual bus, and on buses that fail in every way a real one does."""

import ast
import errno
import logging
import socket
from collections.abc import Iterator
from pathlib import Path
from typing import Any, get_args

import can
import pytest

from simconsole.canbus.bus.port import CanPort, open_bus, read_log
from simconsole.canbus.codec import ECU, Codec, Frame
from simconsole.profiles.can import CanProfile, Interface
from simconsole.values.errors import CanError
from tests.paths import ROOT

DATA = bytes(range(8))


class FakeBus:
    """A bus that takes and gives what a test wants; an exception among the received is raised."""

    def __init__(self) -> None:
        self.sent: list[can.Message] = []
        self.coming: list[can.Message | Exception] = []
        self.on_send: Exception | None = None
        self.closings = 0

    def send(self, message: can.Message, timeout: float | None = None) -> None:
        if self.on_send is not None:
            raise self.on_send
        self.sent.append(message)

    def recv(self, timeout: float | None = None) -> can.Message | None:
        if not self.coming:
            return None
        found = self.coming.pop(0)
        if isinstance(found, Exception):
            raise found
        return found

    def shutdown(self) -> None:
        self.closings += 1


class Yard:
    """Opens fake buses, with a clock of its own."""

    def __init__(self) -> None:
        self.buses: list[FakeBus] = []
        self.now_s = 100.0
        self.refuses = False

    def open(self, profile: CanProfile, ids: frozenset[int]) -> Any:
        if self.refuses:
            raise CanError("network is down")
        self.buses.append(FakeBus())
        return self.buses[-1]

    def port(self, **options: Any) -> CanPort:
        ids = frozenset({0x100, 0x101})
        return CanPort(CanProfile(), ids, frozenset({0x200}), clock_s=lambda: self.now_s, opener=self.open, **options)


def message(can_id: int = 0x200, **options: Any) -> can.Message:
    return can.Message(**{"arbitration_id": can_id, "data": DATA, "is_extended_id": False, **options})


@pytest.fixture
def yard() -> Yard:
    return Yard()


@pytest.fixture(params=["virtual", "udp_multicast"])
def pair(profile: CanProfile, request: pytest.FixtureRequest) -> Iterator[tuple[CanPort, CanPort]]:
    """Two ports on one bus, for each back end that this machine has."""
    if request.param == "udp_multicast":
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as found:
            found.bind(("127.0.0.1", 0))
            profile = CanProfile(port=found.getsockname()[1], log=())
    console = CanPort(profile, frozenset({0x100}), frozenset({0x200}))
    ecu = CanPort(profile, frozenset({0x200}), frozenset({0x100}))
    yield console, ecu
    console.close()
    ecu.close()


def test_frames_pass_both_ways(pair: tuple[CanPort, CanPort]) -> None:
    console, ecu = pair
    assert console.send(Frame(0x100, DATA))
    assert ecu.receive(1.0) == Frame(0x100, DATA)
    assert ecu.send(Frame(0x200, DATA[::-1]))
    assert console.receive(1.0) == Frame(0x200, DATA[::-1])
    assert console.receive(0.0) is None
    assert console.counters()._replace(filtered=0) == (1, 1, 0, 0, 0, 0)


@pytest.mark.parametrize(
    "unwanted",
    [
        message(0x201),
        message(0x100),
        message(0x200, is_extended_id=True),
        message(0x200, is_remote_frame=True, data=b""),
        message(0x200, is_fd=True),
    ],
    ids=["unknown", "own", "extended", "remote", "fd"],
)
def test_only_plain_frames_on_the_whitelist_come_in(yard: Yard, unwanted: can.Message) -> None:
    port = yard.port()
    yard.buses[0].coming = [unwanted, message()]
    assert port.receive(0.0) == Frame(0x200, DATA)
    assert port.receive(0.0) is None
    assert port.counters().filtered == 1


def test_flood_ends_a_call(yard: Yard) -> None:
    port = yard.port()
    yard.buses[0].coming = [message(0x7FF)] * 1000
    assert port.receive(0.0) is None
    assert len(yard.buses[0].coming) == 1000 - 256


@pytest.mark.parametrize("error", [can.CanOperationError("gone"), OSError(errno.ENETDOWN, "network is down")])
def test_failed_send_closes_reports_and_opens_again(
    yard: Yard, error: Exception, caplog: pytest.LogCaptureFixture
) -> None:
    port = yard.port()
    yard.buses[0].on_send = error
    with caplog.at_level(logging.WARNING):
        assert not port.send(Frame(0x100, DATA))
    assert yard.buses[0].closings == 1
    assert "cannot send" in caplog.text
    assert not port.send(Frame(0x100, DATA))
    assert len(yard.buses) == 1
    yard.now_s += 1.0
    assert port.send(Frame(0x100, DATA))
    assert len(yard.buses) == 2
    assert "open again" in caplog.text
    assert port.counters().downs == 1


def test_failed_receive_goes_down_too(yard: Yard) -> None:
    port = yard.port()
    yard.buses[0].coming = [OSError(errno.ENETDOWN, "network is down")]
    assert port.receive(0.0) is None
    assert not port.up
    assert "network is down" in port.recovery.reason


def test_full_send_queue_drops_a_frame_and_no_more(yard: Yard) -> None:
    port = yard.port()
    yard.buses[0].on_send = can.CanOperationError("Transmit buffer full", error_code=errno.ENOBUFS)
    assert not port.send(Frame(0x100, DATA))
    assert port.up
    assert port.counters().dropped == 1


def test_each_failed_try_waits_twice_as_long(yard: Yard) -> None:
    port = yard.port()
    yard.buses[0].on_send = can.CanOperationError("gone")
    port.send(Frame(0x100, DATA))
    yard.refuses = True
    tries = []
    down_s = yard.now_s
    for step in range(1, 130):
        yard.now_s = down_s + 0.5 * step
        before = port.recovery._next_s
        assert not port.up
        if port.recovery._next_s != before:
            tries.append(0.5 * step)
    assert tries == [1, 3, 7, 15, 31, 61]


def test_whitelist_is_the_only_way_out(yard: Yard) -> None:
    port = yard.port()
    for can_id in range(0x800):
        for extended in (False, True):
            if can_id in (0x100, 0x101) and not extended:
                continue
            with pytest.raises(CanError, match="not one that this program may send"):
                port.send(Frame(can_id, DATA, extended))
    assert yard.buses[0].sent == []


def test_only_the_port_imports_python_can() -> None:
    """So nothing can reach a bus but through `CanPort.send`."""
    found = set()
    for path in (ROOT / "simconsole").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            names += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            if any(name.split(".")[0] == "can" for name in names):
                found.add(path.relative_to(ROOT).as_posix())
    assert found == {"simconsole/canbus/bus/port.py"}
    tree = ast.parse((ROOT / "simconsole/canbus/bus/port.py").read_text())
    sends = [node for node in ast.walk(tree) if isinstance(node, ast.Attribute) and node.attr == "send"]
    assert len(sends) == 1


@pytest.mark.parametrize(("suffix", "reads"), [("blf", 5), ("log", 5), ("asc", 5)])
def test_logs_hold_what_passed_both_ways(yard: Yard, tmp_path: Path, suffix: str, reads: int) -> None:
    path = tmp_path / f"can.{suffix}"
    port = yard.port(logs=(path,))
    for index in range(3):
        port.send(Frame(0x100, bytes((index,)) + DATA[1:]))
    yard.buses[0].coming = [message(timestamp=1.7e9 + index) for index in range(2)]
    while port.receive(0.0):
        pass
    port.close()
    frames = [frame for _, frame in read_log(path)]
    assert len(frames) == reads
    assert [frame.data[0] for frame in frames[:3]] == [0, 1, 2]
    assert frames[3] == Frame(0x200, DATA)


def test_log_on_a_full_disk_ends_and_the_bus_goes_on(yard: Yard, caplog: pytest.LogCaptureFixture) -> None:
    port = yard.port(logs=(Path("/dev/full"),))
    with caplog.at_level(logging.WARNING):
        for _ in range(2000):
            assert port.send(Frame(0x100, DATA))
        port.close()
    assert "log" in caplog.text


@pytest.mark.parametrize(
    ("name", "content"),
    [
        *(("short.blf", b"LOGG" + bytes(20)), ("missing.blf", None), ("noise.blf", bytes(range(256)) * 4)),
        *(("noise.log", bytes(range(128, 256))), ("words.log", b"no log at all\n"), ("bus.txt", b"")),
    ],
)
def test_what_is_no_log_is_refused(tmp_path: Path, name: str, content: bytes | None) -> None:
    path = tmp_path / name
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(CanError, match=name.replace(".", r"\.")) as caught:
        read_log(path)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("interface", "channel"),
    [
        ("socketcan", "can7"),
        ("pcan", "PCAN_USBBUS1"),
        ("udp_multicast", "127.0.0.1"),
        ("udp_multicast", "no.such.host"),
    ],
)
def test_bus_that_is_not_there_is_one_line(interface: Any, channel: str, codec: Codec) -> None:
    with pytest.raises(CanError, match=f"{interface} {channel}") as caught:
        open_bus(CanProfile(interface=interface, channel=channel), codec.ids(ECU))
    assert "\n" not in str(caught.value)


def test_closing_twice_lets_go_of_the_bus_once(yard: Yard) -> None:
    port = yard.port()
    assert port.send(Frame(0x100, DATA))
    port.close()
    port.close()
    assert yard.buses[0].closings == 1
    assert not port.send(Frame(0x100, DATA))
    assert len(yard.buses[0].sent) == 1


def test_every_interface_of_a_profile_is_one_of_python_can() -> None:
    assert set(get_args(Interface)) <= set(can.VALID_INTERFACES)


@pytest.mark.parametrize("interface", ["pcan", "vector", "kvaser", "socketcan"])
def test_interfaces_of_vendors_get_what_the_profile_says(interface: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: dict[str, Any] = {}
    monkeypatch.setattr(can, "Bus", lambda **options: asked.update(options))
    open_bus(CanProfile(interface=interface, channel="can7", bitrate_bps=250_000), frozenset({0x200}))
    assert (asked["interface"], asked["channel"], asked["bitrate"]) == (interface, "can7", 250_000)
    assert asked["can_filters"] == (
        [{"can_id": 0x200, "can_mask": 0x7FF, "extended": False}] if interface == "socketcan" else None
    )


def test_error_frames_are_counted_and_told_seldom(yard: Yard, caplog: pytest.LogCaptureFixture) -> None:
    port = yard.port()
    yard.buses[0].coming += [can.Message(arbitration_id=0x20, is_error_frame=True) for _ in range(50)]
    with caplog.at_level(logging.WARNING):
        assert port.receive(0.0) is None
    assert port.counters().error_frames == 50
    assert [record.getMessage() for record in caplog.records if "error frame" in record.getMessage()] == [
        f"CAN {port._profile.channel}: error frame: no acknowledgement (1 so far)"
    ]
    assert port.up
