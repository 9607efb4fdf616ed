"""The bridge's section: names, addresses and bounds that are refused by key and value."""

import pytest

from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.files.loader import parse
from tests.profiles.refused import refusal


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("port: 65536", "port: value 65536: "),
        ("host: ''", "host: "),
        ("namespace: ego", 'namespace: value "ego"'),
        ("namespace: /ego/", "namespace: "),
        ("rename: {/odom: odom}", "rename"),
        ("rename: {odom: /odom}", "rename"),
        ("rates_hz: {/odom: 1001}", "rates_hz./odom: value 1001: "),
        ("rates_hz: {/odom: -1}", "rates_hz./odom: value -1: "),
        ("allowed_origins: ['file://x']", "allowed_origins[0]: "),
        ("allowed_origins: ['http://x/page']", "allowed_origins[0]: "),
        ("allowed_hosts: ['a b']", "allowed_hosts[0]: "),
        ("anonymous: control", 'anonymous: value "control": one of '),
        ("limits: {message_bytes: 1023}", "limits.message_bytes: value 1023: "),
        ("commands: {road_wheel_rad: 1.3}", "commands.road_wheel_rad: value 1.3: "),
        ("commands: {speed_mps: 0}", "commands.speed_mps: value 0: "),
        ("upstream: {url: 'http://there'}", "upstream.url: "),
        ("ros2: {domain_id: 233}", "ros2.domain_id: value 233: "),
        ("ros2: {node: 7up}", "ros2.node: "),
        ("tokenz: tokens.txt", 'tokenz: value "tokens.txt": unknown key, did you mean tokens?'),
    ],
)
def test_what_cannot_be_meant_is_refused(text: str, told: str) -> None:
    assert told in refusal(text, BridgeProfile)


def test_what_can_be_meant_is_read() -> None:
    profile = parse(
        "port: 0\nnamespace: /ego/car_1\nrename: {/odom: /ego/odometry}\nrates_hz: {/odom: 0}\n"
        "allowed_origins: ['https://x.org:8080', 'null', 'file://', 'app://-']\n"
        "allowed_hosts: ['[::1]:9090']\nupstream: {url: 'wss://there/rosbridge'}\n",
        BridgeProfile,
        "f.yaml",
    )
    assert profile.rates_hz == {"/odom": 0.0}
    assert profile.upstream is not None


def test_as_shipped_nobody_outside_this_machine_gets_in() -> None:
    plain = parse("{}", BridgeProfile, "f.yaml")
    assert (plain.host, plain.trust_network, plain.anonymous) == ("127.0.0.1", False, "none")
    assert plain.dead_after_s > plain.ping_interval_s, "a client is asked before it is taken for gone"
