"""`simconsole can monitor | send | replay`: the bus tools."""

from argparse import Namespace
from pathlib import Path

from simconsole.cli.outcome import Outcome
from simconsole.profiles.can import CanProfile
from simconsole.profiles.validation import convert
from simconsole.values.errors import CanError
from simconsole.values.units import RAD_PER_DEG

_DIRECTIONS = {"drive": 1.0, "neutral": 0.0, "reverse": -1.0}
_INDICATORS = {"left": 1.0, "off": 0.0, "right": -1.0}


def can(options: Namespace) -> Outcome:
    """Do one of the three until interrupted or its time is over.

    Raises:
        CanError: the bus or a log cannot be used.
        ProfileError: an option is out of its bounds, or the DBC is missing.
    """
    from simconsole.canbus.bus.bus_tools import monitor, replay, send
    from simconsole.canbus.bus.worker import load_codec
    from simconsole.canbus.ecu import Wish
    from simconsole.canbus.messages import REQUESTS

    profile, codec = _profile(options), load_codec()
    if options.action == "monitor":
        logs = () if options.file is None else (Path(options.file),)
        results = monitor(profile, codec, say=_say, duration_s=options.duration_s, logs=logs)
        return Outcome(0 if results["messages"] else 1, results, "" if results["messages"] else "nothing was heard")
    if options.action == "replay":
        if not 0.01 <= options.speed <= 100.0:
            raise CanError(f"--speed: value {options.speed:g}: 0.01 to 100")
        results = replay(profile, codec, Path(options.file), node=options.node, speed=options.speed)
        return Outcome(0, results, f"sent {results['sent']} frames of {options.node}, left out {results['left_out']}")
    names = {event.name: number for number, event in REQUESTS.items()}
    wish = Wish(
        road_wheel_rad=options.road_wheel_deg * RAD_PER_DEG,
        accel_mps2=options.accel_mps2,
        speed_mps=options.speed_mps,
        direction=_DIRECTIONS[options.direction],
        turn_indicators=_INDICATORS[options.turn_indicators],
        hazard_lights=float(options.hazard_lights),
        engage=options.engage,
        request=names.get(options.request or "", 0),
    )
    results = send(profile, codec, wish, duration_s=options.duration_s)
    text = f"sent {results['sent']} commands, heard {results['heard']} frames, speed {results['speed_mps']} m/s"
    return Outcome(0, results, text)


def _say(line: str) -> None:
    print(line, flush=True)


def _profile(options: Namespace) -> CanProfile:
    plain = {
        "interface": options.interface,
        "channel": options.channel,
        "port": options.port,
        "bitrate_bps": options.bitrate,
    }
    given = {key: value for key, value in plain.items() if value is not None}
    return convert(given, CanProfile, "command line")
