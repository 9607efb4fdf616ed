"""`simconsole can monitor | send | replay`: the bus tools."""

from argparse import Namespace
from pathlib import Path

import msgspec

from simconsole.cli.outcome import Outcome
from simconsole.profiles.can import CanProfile
from simconsole.values.errors import CanError
from simconsole.values.units import RAD_PER_DEG

_DIRECTIONS = {"drive": 1.0, "neutral": 0.0, "reverse": -1.0}
_INDICATORS = {"left": 1.0, "off": 0.0, "right": -1.0}


def can(words: Namespace) -> Outcome:
    """Do one of the three until interrupted or its time is over.

    Raises:
        CanError: the bus, a log or an option cannot be used.
        ProfileError: the DBC is missing.
    """
    from simconsole.canbus.bus.bus_tools import monitor, replay, send
    from simconsole.canbus.bus.worker import load_codec
    from simconsole.canbus.ecu import Wish
    from simconsole.canbus.messages import REQUESTS

    profile, codec = _profile(words), load_codec()
    if words.action == "monitor":
        logs = () if words.file is None else (Path(words.file),)
        results = monitor(profile, codec, say=_say, duration_s=words.duration_s, logs=logs)
        return Outcome(0 if results["messages"] else 1, results, "" if results["messages"] else "nothing was heard")
    if words.action == "replay":
        if words.file is None:
            raise CanError("can replay: value missing: --file FILE, a log")
        if not 0.01 <= words.speed <= 100.0:
            raise CanError(f"--speed: value {words.speed:g}: 0.01 to 100")
        results = replay(profile, codec, Path(words.file), node=words.node, speed=words.speed)
        return Outcome(0, results, f"sent {results['sent']} frames of {words.node}, left out {results['left_out']}")
    names = {event.name: number for number, event in REQUESTS.items()}
    wish = Wish(
        road_wheel_rad=words.road_wheel_deg * RAD_PER_DEG,
        accel_mps2=words.accel_mps2,
        speed_mps=words.speed_mps,
        direction=_DIRECTIONS[words.direction],
        turn_indicators=_INDICATORS[words.turn_indicators],
        hazard_lights=float(words.hazard_lights),
        engage=words.engage,
        request=names.get(words.request or "", 0),
    )
    results = send(profile, codec, wish, duration_s=words.duration_s)
    text = f"sent {results['sent']} commands, heard {results['heard']} frames, speed {results['speed_mps']} m/s"
    return Outcome(0, results, text)


def _say(line: str) -> None:
    print(line, flush=True)


def _profile(words: Namespace) -> CanProfile:
    plain = {"interface": words.interface, "channel": words.channel, "port": words.port, "bitrate_bps": words.bitrate}
    given = {key: value for key, value in plain.items() if value is not None}
    try:
        return msgspec.convert(given, CanProfile)
    except msgspec.ValidationError as error:
        raise CanError(f"command line: {error}") from None
