"""The bus of one machine: it hears others and not itself, whatever else comes in on its port, on python-can's wire."""

import os
import re
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import can
import pytest
from can.interfaces.udp_multicast import utils

from simconsole.canbus.bus import multicast
from simconsole.canbus.bus.multicast import LoopbackBus, drop_from
from tests.paths import ROOT
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


def test_it_speaks_with_a_plain_python_can_program_by_the_recipe_of_the_documentation() -> None:
    """In a network of its own, whose default route leads out of a card that is none, as a machine's does."""
    recipe = re.search(r"^    (ip route add .* dev lo)$", (ROOT / "docs" / "can.md").read_text(), re.MULTILINE)
    assert recipe is not None
    card = "ip link set lo up; ip link add card type veth peer name far; ip addr add 10.9.8.7/24 dev card; "
    up = "ip link set far up; ip link set card up; ip route add default via 10.9.8.1; "
    route = "ip -oneline route get 239.74.163.2; "
    peers = f"{sys.executable} {Path(__file__).with_name('multicast_peers.py')}"
    done = subprocess.run(
        ["unshare", "--map-root-user", "--net", "sh", "-ec", f"{card}{up}{route}{recipe[1]}; {route}{peers}"],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )
    assert done.returncode == 0, done.stderr
    before, after, heard = done.stdout.splitlines()
    assert "dev card" in before, "as on a machine with a network"
    assert "dev lo" in after
    assert heard == "0x111 0x222", "each hears the other"


def test_group_that_is_none_is_refused(port: int) -> None:
    with pytest.raises(OSError):  # noqa: PT011  # whatever the kernel says
        LoopbackBus("10.0.0.1", port, utils.pack_message, unpack)


def test_kernel_filter_is_asked_for_only_where_there_is_one() -> None:
    class Refusing:
        def setsockopt(self, *words: object) -> None:
            raise OSError("no such option")

    assert drop_from(Refusing(), 1) is False  # type: ignore[arg-type]  # a socket of another system
