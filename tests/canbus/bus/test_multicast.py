"""The bus of one machine: it hears others and not itself, whatever else comes in on its port, on python-can's wire."""

import socket
from collections.abc import Iterator

import can
import pytest
from can.interfaces.udp_multicast import utils

from simconsole.canbus.bus import multicast
from simconsole.canbus.bus.multicast import LoopbackBus, drop_from
from tests.patience import PATIENCE_S

GROUP = "239.74.163.9"


def unpack(data: bytes, now_s: float) -> can.Message:
    return utils.unpack_message(data, replace={"timestamp": now_s}, check=True)


@pytest.fixture
def port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("", 0))
        return int(free.getsockname()[1])


@pytest.fixture
def pair(port: int) -> Iterator[tuple[LoopbackBus, LoopbackBus]]:
    buses = LoopbackBus(GROUP, port, utils.pack_message, unpack), LoopbackBus(GROUP, port, utils.pack_message, unpack)
    yield buses
    for bus in buses:
        bus.shutdown()
        bus.shutdown()


def message(number: int) -> can.Message:
    return can.Message(arbitration_id=number, data=bytes(range(8)), is_extended_id=False)


def test_others_are_heard_and_the_bus_itself_is_not(
    pair: tuple[LoopbackBus, LoopbackBus], monkeypatch: pytest.MonkeyPatch
) -> None:
    one, other = pair
    monkeypatch.setattr("simconsole.canbus.bus.multicast.time.time", lambda: 1_800_000_000.5)
    one.send(message(0x101))
    heard = other.recv(PATIENCE_S)
    assert heard is not None
    assert (heard.arbitration_id, bytes(heard.data)) == (0x101, bytes(range(8)))
    assert heard.timestamp == 1_800_000_000.5, "the system's clock, as logs of CAN have it"
    assert one.recv(0.0) is None
    assert other.recv(0.0) is None


def test_own_frames_do_not_even_wake_it(pair: tuple[LoopbackBus, LoopbackBus]) -> None:
    one, other = pair
    one.send(message(0x101))
    assert other.recv(PATIENCE_S) is not None, "so that it has gone round"
    with pytest.raises(BlockingIOError):
        one._in.recvfrom(4096)


def test_where_the_kernel_cannot_drop_them_the_source_port_tells(port: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(multicast, "drop_from", lambda receiver, number: False)
    one = LoopbackBus(GROUP, port, utils.pack_message, unpack)
    other = LoopbackBus(GROUP, port, utils.pack_message, unpack)
    try:
        one.send(message(0x101))
        other.send(message(0x202))
        heard = one.recv(PATIENCE_S)
        assert heard is not None
        assert heard.arbitration_id == 0x202
    finally:
        one.shutdown()
        other.shutdown()


def test_what_is_no_message_is_passed_over(pair: tuple[LoopbackBus, LoopbackBus]) -> None:
    one, other = pair
    for junk in (b"", b"\xc1", b"x" * 2000):
        one._out.send(junk)
    one.send(message(0x103))
    heard = other.recv(PATIENCE_S)
    assert heard is not None
    assert heard.arbitration_id == 0x103


def test_it_speaks_with_python_can_itself(pair: tuple[LoopbackBus, LoopbackBus], port: int) -> None:
    one, _ = pair
    theirs = can.Bus(interface="udp_multicast", channel=GROUP, port=port, hop_limit=0)
    try:
        group, loopback = socket.inet_aton(GROUP), socket.inet_aton("127.0.0.1")
        inner = theirs._multicast._socket  # type: ignore[attr-defined]  # as python-can names it
        inner.setsockopt(socket.IPPROTO_IP, socket.IP_DROP_MEMBERSHIP, group + socket.inet_aton("0.0.0.0"))
        inner.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, group + loopback)
        inner.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, loopback)
        theirs.send(message(0x111))
        heard = one.recv(PATIENCE_S)
        assert heard is not None
        assert heard.arbitration_id == 0x111
        one.send(message(0x222))
        numbers = []
        while (got := theirs.recv(PATIENCE_S)) is not None and got.arbitration_id != 0x222:
            numbers.append(got.arbitration_id)
        assert got is not None
        assert set(numbers) <= {0x111}, "it hears itself"
    finally:
        theirs.shutdown()


def test_group_that_is_none_is_refused(port: int) -> None:
    with pytest.raises(OSError):  # noqa: PT011  # whatever the kernel says
        LoopbackBus("10.0.0.1", port, utils.pack_message, unpack)


def test_kernel_filter_is_asked_for_only_where_there_is_one() -> None:
    class Refusing:
        def setsockopt(self, *words: object) -> None:
            raise OSError("no such option")

    assert drop_from(Refusing(), 1) is False  # type: ignore[arg-type]  # a socket of another system
