"""Where clients of this machine reach a server."""

import pytest

from simconsole.bridge.transport.addresses import reached_here


@pytest.mark.parametrize(
    ("url", "here"),
    [
        ("wss://0.0.0.0:9", "wss://127.0.0.1:9"),
        ("ws://[::]:9", "ws://[::1]:9"),
        ("ws://10.0.0.1:9", "ws://10.0.0.1:9"),
    ],
)
def test_a_server_on_all_addresses_is_reached_on_this_machine(url: str, here: str) -> None:
    assert reached_here(url) == here
