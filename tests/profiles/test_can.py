"""The bus's section: what is refused, and that it stays on this machine by itself."""

from ipaddress import ip_address, ip_network

import pytest

from simconsole.profiles.can import CanProfile
from simconsole.profiles.files.loader import parse
from tests.profiles.refused import refusal


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("interface: can0", 'interface: value "can0": one of '),
        ("channel: ''", "channel: "),
        ("channel: 'a b'", "channel: "),
        ("channel: '-x'", "channel: "),
        ("port: 1023", "port: value 1023: "),
        ("bitrate_bps: 1000001", "bitrate_bps: value 1000001: "),
        ("log: [mf4]", 'log[0]: value "mf4": one of asc, blf, candump'),
        ("command_timeout_ms: 19", "command_timeout_ms: value 19: "),
        ("counter_step_max: 8", "counter_step_max: value 8: "),
        ("invalid_max: 0", "invalid_max: value 0: "),
        ("retry_last_s: 31", "retry_last_s: value 31: "),
    ],
)
def test_what_cannot_be_meant_is_refused(text: str, told: str) -> None:
    assert told in refusal(text, CanProfile)


@pytest.mark.parametrize("channel", ["can0", "PCAN_USBBUS1", "0", "239.74.163.2", "tty/USB0"])
def test_channels_of_every_back_end_are_read(channel: str) -> None:
    assert parse(f"interface: socketcan\nchannel: '{channel}'\n", CanProfile, "f.yaml").channel == channel


def test_as_shipped_it_is_a_group_that_no_router_forwards() -> None:
    plain = parse("{}", CanProfile, "f.yaml")
    assert plain.interface == "udp_multicast"
    assert ip_address(plain.channel).is_multicast
    assert ip_address(plain.channel) in ip_network("239.0.0.0/8"), "administratively scoped"
    assert plain.retry_first_s <= plain.retry_last_s
