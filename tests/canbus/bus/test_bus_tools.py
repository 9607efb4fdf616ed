from pathlib import Path

from simconsole.canbus.bus.bus_tools import monitor
from simconsole.canbus.bus.port import CanPort, read_log
from simconsole.canbus.codec import ECU, Codec
from simconsole.profiles.can import CanProfile
from tests.canbus.programs import results, running


def test_what_monitor_kept_is_replayed_and_heard_again(port: int, codec: Codec, tmp_path: Path) -> None:
    profile = CanProfile(port=port, log=())
    path = tmp_path / "heard.blf"
    with running("can", "send", "--port", str(port), "--for", "1") as ecu:
        heard = monitor(profile, codec, say=lambda line: None, logs=(path,), stop=lambda: ecu.poll() is not None)
        assert 0 < results(ecu)["sent"] <= 50  # late by a period: that one is not made up for
    states = heard["messages"]["ECU_COMMAND"]["states"]
    assert sum(states.values()) == len(read_log(path)) > 0
    listening = CanPort(profile, frozenset(), codec.ids(ECU))
    with running("can", "replay", "--port", str(port), "--file", str(path), "--speed", "5") as process:
        assert results(process)["sent"] == len(read_log(path))
    again = []
    while (frame := listening.receive(0.0)) is not None:
        again.append(frame)
    listening.close()
    assert again == [frame for _, frame in read_log(path)]
