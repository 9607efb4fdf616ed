"""The bus tools: monitor a bus, simulate an ECU, replay a log. Each opens the bus itself, beside any console."""

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

from simconsole.canbus.bus.port import CanPort, read_log
from simconsole.canbus.codec import COMMAND, Codec, Frame
from simconsole.canbus.ecu import Ecu, Listener, Wish
from simconsole.profiles.can import CanProfile
from simconsole.values.errors import CanError

_NOBODY: Final[frozenset[int]] = frozenset()
_LINE_S: Final = 1.0
_MS_PER_S: Final = 1000.0

Say = Callable[[str], None]


def monitor(
    profile: CanProfile,
    codec: Codec,
    *,
    say: Say,
    duration_s: float | None = None,
    logs: tuple[Path, ...] = (),
    stop: Callable[[], bool] = lambda: False,
) -> dict[str, Any]:
    """Decode and judge every message of the DBC until interrupted; nothing is sent.

    Args:
        profile: which bus.
        codec: the messages.
        say: shows a line about each message once a second.
        duration_s: how long; None: until interrupted.
        logs: files to keep what was seen (.blf, .asc, .log).
        stop: ends it once it returns True and no frame is left.

    Returns:
        By message: frames by state, rate in 1/s, last values.

    Raises:
        CanError: the bus or a log cannot be opened.
    """
    listener = Listener(codec)
    port = CanPort(profile, _NOBODY, listener.ids, logs=logs)
    seen: dict[str, dict[str, Any]] = {}
    began_s = shown_s = time.monotonic()
    try:
        while duration_s is None or time.monotonic() - began_s < duration_s:
            frame = port.receive(0.05)
            if frame is not None:
                _note(seen, listener, frame)
            elif stop():
                break
            if time.monotonic() - shown_s >= _LINE_S:
                shown_s = time.monotonic()
                for line in _lines(seen, shown_s - began_s):
                    say(line)
    except KeyboardInterrupt:
        say("")
    finally:
        port.close()
    passed_s = time.monotonic() - began_s
    for entry in seen.values():
        entry["rate_hz"] = sum(entry["states"].values()) / passed_s
    return {"duration_s": passed_s, "messages": seen, "lost": listener.lost(), "port": port.counters()._asdict()}


def send(profile: CanProfile, codec: Codec, wish: Wish, *, duration_s: float | None = None) -> dict[str, Any]:
    """Simulate the ECU: send ECU_COMMAND at its period, on absolute deadlines, and receive the console's messages.

    Returns:
        Frames sent, and what the console said last.

    Raises:
        CanError: the bus cannot be opened, or the wish is out of range.
    """
    ecu = Ecu(codec, wish)
    port = CanPort(profile, ecu.transmit_ids, ecu.receive_ids)
    period_s = codec.messages[COMMAND].period_ms / _MS_PER_S
    began_s = time.monotonic()
    modes: list[int] = []
    top_mps, due = 0.0, 0
    try:
        while duration_s is None or due * period_s < duration_s:
            port.send(ecu.command())
            due += 1
            while (left_s := began_s + due * period_s - time.monotonic()) > 0.0:
                frame = port.receive(left_s)
                if frame is not None:
                    ecu.receive(frame, time.monotonic_ns())
            if ecu.mode is not None and modes[-1:] != [ecu.mode]:
                modes.append(ecu.mode)
            top_mps = max(top_mps, abs(ecu.speed_mps or 0.0))
            due = max(due, int((time.monotonic() - began_s) / period_s))  # whole periods late: they are skipped
    except KeyboardInterrupt:
        pass
    finally:
        port.close()
    return {
        "sent": port.counters().sent,
        "heard": port.counters().received,
        "modes": modes,
        "speed_mps": ecu.speed_mps,
        "top_speed_mps": top_mps,
    }


def replay(profile: CanProfile, codec: Codec, path: Path, *, node: str, speed: float = 1.0) -> dict[str, Any]:
    """Send one node's frames of a log again, unchanged and with their time spacing; other ids are left out.

    Args:
        profile: which bus.
        codec: the messages.
        path: a log (.blf, .log of candump, .asc).
        node: whose messages, a name of the DBC.
        speed: times as fast.

    Raises:
        CanError: no such node, no such log, or the bus cannot be opened.
    """
    ids = codec.ids(node)
    if not ids:
        raise CanError(f"node {node}: not in the DBC")
    frames = read_log(path)
    wanted = [(t_s, frame) for t_s, frame in frames if frame.can_id in ids and not frame.extended]
    port = CanPort(profile, ids, _NOBODY)
    began_s = time.monotonic()
    try:
        for t_s, frame in wanted:
            left_s = began_s + t_s / speed - time.monotonic()
            if left_s > 0.0:
                time.sleep(left_s)
            port.send(frame)
    except KeyboardInterrupt:
        pass
    finally:
        port.close()
    return {"sent": port.counters().sent, "left_out": len(frames) - len(wanted), "node": node}


def _note(seen: dict[str, dict[str, Any]], listener: Listener, frame: Frame) -> None:
    heard = listener.take(frame, time.monotonic_ns())
    if heard is None:
        return
    entry = seen.setdefault(heard.name, {"id": f"{frame.can_id:#x}", "states": {}, "values": {}})
    entry["states"][heard.state.name] = entry["states"].get(heard.state.name, 0) + 1
    if heard.values is not None:
        entry["values"] = heard.values


def _lines(seen: dict[str, dict[str, Any]], passed_s: float) -> list[str]:
    lines = [f"-- {passed_s:.0f} s"]
    for name, entry in sorted(seen.items(), key=lambda item: str(item[1]["id"])):
        values = "  ".join(f"{signal} {value:g}" for signal, value in entry["values"].items())
        bad = {state: count for state, count in entry["states"].items() if state not in ("OK", "NO_NEW_DATA")}
        lines.append(f"{entry['id']} {name:<14} {sum(entry['states'].values()):6d}  {values}  {bad or ''}".rstrip())
    return lines
