"""The 68 cases of the fault catalogue and where they are tested: D devices, R ROS commands, N the network, P the
process, C CAN, F files.

What is promised stands as the tests assert it: where the bar is one of real time, in ticks, counts, bytes or processor
time. A test of a case says so with `@pytest.mark.fault("D01")`.
"""

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Final, NamedTuple

from tests.paths import ROOT

TESTS: Final = ROOT / "tests"


class Case(NamedTuple):
    """One case."""

    number: str
    fault: str
    promised: str


CATALOGUE: Final = (
    Case("D01", "wheel unplugged by hand", "safe stop within 50 ms of ticks, alert, event, car at rest"),
    Case("D02", "wheel unplugged in autonomy", "take-over request; safe stop after 10 s of ticks unless plugged in"),
    Case("D03", "device open but silent", "stale after 100 ms of ticks; a wheel that rests for 60 s is no fault"),
    Case("D04", "replugged at another place", "known by its identity; control only at rest and within 5 deg"),
    Case("D05", "pedal stuck at 100 % at the start", "PARKED until the throttle was seen at 5 % or less"),
    Case("D06", "both pedals pressed", "brake wins, throttle 0"),
    Case("D07", "axis out of range, NaN, infinite, missing", "last good value for 100 ms of ticks, then lost"),
    Case("D08", "two gears, or R above 2 m/s", "gear kept, driver warned"),
    Case("D09", "calibration inverted", "start refused in one line"),
    Case(
        "D10",
        "burst of 10^5 events of a device",
        "newest value used, no queue; at most 0.1 % of the ticks cost more CPU time than a tick lasts",
    ),
    Case("D11", "process killed while the motor pushes", "force gone; the first act after a restart is stop-all"),
    Case("D12", "loop hangs while the motor pushes", "effects of at most 200 ms, re-armed only by a healthy loop"),
    Case("D13", "motor told NaN, too much, or a flip every tick", "finite, clipped, within the slew limit"),
    Case("R01", "command older than 200 ms", "0 applied of 10^5"),
    Case("R02", "commands stop", "safe stop within 210 ms of ticks"),
    Case("R03", "late but steady, 150 ms", "taken; age shown"),
    Case("R04", "out of order, twice, or from the future", "refused and counted"),
    Case("R05", "NaN, infinite, 1e308, subnormal in every field", "refused whole; output finite"),
    Case(
        "R06",
        "full lock at once: as a step, a ramp, on and off, by senders of any rate",
        "rate-limited; AUTONOMOUS left within command_stale_s + 10 ms + a tick of the last plausible command",
    ),
    Case("R07", "wrong type, wrong, extra or missing field", "status, nothing applied, connection stays"),
    Case("R08", "wrong frame or unit", "refused"),
    Case(
        "R09",
        "flood, 10^4 commands a second for 60 s",
        "age of the applied one: p99 20 ms, at most 50 ms of simulated time; 500 a second taken, client told; over a "
        "socket every command accounted for and resident memory flat",
    ),
    Case("R10", "two clients command", "one lease; the other is told; free 500 ms after silence or on close"),
    Case("R11", "client without authority commands", "refused, counted, no effect"),
    Case("R12", "request while moving, twice, with the brake pressed", "refused with its reason"),
    Case("R13", "mode toggled at 50 Hz for 10 s", "no jump beyond one rate step, no dead state"),
    Case("N01", "connection closes in autonomy", "safe stop at once; other clients unaffected"),
    Case(
        "N02",
        "100 reconnects",
        "subscriptions back, nobody engaged; files, tasks, threads constant, resident memory within 1 MiB",
    ),
    Case(
        "N03",
        "server restarts under its clients",
        "port free for the first try; each client back with its first try after; a drive on it begins PARKED",
    ),
    Case("N04", "connection half open", "safe stop within 210 ms of ticks; freed after 3 s of the server's clock"),
    Case(
        "N05",
        "subscriber that reads slowly or not at all",
        "1 MiB queued at most, newest kept, oldest counted; others lose nothing and cost no more CPU time",
    ),
    Case(
        "N06",
        "30 % loss, 200 ms delay, 1 Mbit/s",
        "order kept; nothing older than 200 ms of ticks is driven by; 210 ms without a plausible command end autonomy",
    ),
    Case(
        "N07",
        "malformed frames, 1,000 kinds and random ones by volume",
        "1 ms of CPU time each; status; next valid one taken",
    ),
    Case("N08", "frame of 2 MiB, header of 1 GiB", "closed with 1009, less than 2 MiB kept"),
    Case("N09", "nested 10^5 deep", "refused within 1 ms of CPU time"),
    Case("N10", "compression bomb", "compression is off"),
    Case("N11", "CBOR bombs", "refused within 1 ms of CPU time"),
    Case("N12", "200 idle handshakes", "ended after the limit; clients unaffected"),
    Case("N13", "message in 10^6 fragments of a byte", "closed after 256 at most; resident memory flat"),
    Case("N14", "pieces of rosbridge that never end", "per client, 8 sets, 1 MiB, 5 s"),
    Case("N15", "page from elsewhere (Origin)", "403 before the upgrade"),
    Case("N16", "other Host", "refused"),
    Case("N17", "10^4 topics, names that are none", "256 subscriptions, 256 characters, status"),
    Case("N18", "JSON that readers read differently", "refused"),
    Case("N19", "frames against the rules, ping flood", "ended in order, or answered"),
    Case("P01", "disk full while recording", "drive goes on, alarm, log readable to its last record"),
    Case("P02", "kill -9 while recording, 50 times", "at most one tick lost; opens without repair"),
    Case("P03", "power cut: the tail that was not synced is gone", "all records before it are read; loss is named"),
    Case("P04", "torn tail, flipped bits, cut at every byte", "whole records returned, the break named, no traceback"),
    Case("P05", "wall clock jumps", "not one bit changes"),
    Case("P06", "loop stands for 15, 50, 500 ms", "counted; above 100 ms safe stop and no force; at most 5 late ticks"),
    Case(
        "P07",
        "garbage: 2 GiB made during a drive",
        "heap frozen: no collection of the ticks looks at what was there before; 5 ms of CPU time for p99.9 of them",
    ),
    Case(
        "P08",
        "soak of eight hours",
        "resident memory at most 1 MiB an hour after the first ten minutes, files constant",
    ),
    Case("P09", "viewer closed, never there, frozen", "core never waits for the scene; its memory is bounded"),
    Case("P10", "HUD crashes", "drive goes on, HUD restarted"),
    Case("P11", "SIGTERM, Ctrl-C in any state, twice", "vehicle stopped for the log, bundle whole, code 0 or 130"),
    Case("P12", "exception in any part", "isolated, told once, safe state where it was a source of control"),
    Case("C01", "wrong checksum, counter, length", "dropped; five in a row or 200 ms of ticks end the commands"),
    Case("C02", "bus off, error frames, network down", "reported; tried again after 1 to 30 s; loop not held up"),
    Case("C03", "bus flood", "filtered; no tick differs"),
    Case("C04", "old frame again", "refused"),
    Case("C05", "frame off the list of what may be sent", "impossible"),
    Case("F01", "profile name that leaves its folder", "refused, nothing opened outside"),
    Case("F02", "YAML that attacks its reader", "refused within bounds"),
    Case("F03", "wrong unit, negative mass, NaN", "start refused with the field's path"),
    Case("F04", "unknown key", "refused, the near name suggested"),
    Case("F05", "recording of a newer version, cut, of another byte order", "one line, exit code 2"),
    Case("F06", "trace that goes back in time, has gaps or 10^7 rows", "refused with its line; constant memory"),
)


@cache
def places(tests: Path = TESTS) -> dict[str, list[str]]:
    """Return the files (from the root of the project) that have a test of a case, by the case's id."""
    found: dict[str, list[str]] = {}
    for path in sorted(tests.rglob("test_*.py")):
        for number in sorted(set(marks(path.read_text("utf-8")))):
            found.setdefault(number, []).append(path.relative_to(tests.parent).as_posix())
    return found


def tested() -> dict[str, list[str]]:
    """Return the files of each case, those of the drives on the course among them, whose ids stand in a list."""
    from tests.faults.cases import CASES

    found = places()
    for number in (number for case in CASES for number in case.number.split()):
        found[number] = sorted({*found.get(number, ()), "tests/faults/test_course.py"})
    return found


def marks(source: str) -> Iterator[str]:
    """Yield the ids of `pytest.mark.fault("ID")` in a test file."""
    for node in ast.walk(ast.parse(source)):
        if not isinstance(node, ast.Call) or ast.unparse(node.func) != "pytest.mark.fault":
            continue
        yield from (str(given.value) for given in node.args if isinstance(given, ast.Constant))
