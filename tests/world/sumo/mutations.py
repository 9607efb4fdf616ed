"""Networks with one thing wrong after the other, and a program that reads them within bounds.

`python -m tests.world.sumo.mutations SEED COUNT FILE` prints one line of JSON: how many were refused and loaded, the
most CPU seconds that one took, and the memory of the process.
"""

import json
import random
import re
import resource
import signal
import sys
import time
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path

from simconsole.profiles.world import MapFile, RandomRoute, RoadsProfile
from simconsole.values.errors import ProfileError
from simconsole.world.roads.road_world import planned
from simconsole.world.sumo.net_reader import read_net

CPU_S = 2.0
MEMORY_BYTES = 500_000_000
NASTY = (
    *(
        "",
        " ",
        "nan",
        "inf",
        "-inf",
        "1e308",
        "-1",
        "0",
        "1e-320",
        "99999999999999999999",
        "x",
        "\u0661",
        "0x10",
        "1_0",
    ),
    *("1,2 3", "nan,nan 1,1", "1,1 1,1", "1e9,0 0,1e9", "5,5,5,5 1,1", ":", ":_", "_", "a b", "\u202e", "A" * 100_000),
    *("1,1 " * 6000, "-0", "True", "None", "..", "all", "passenger"),
)
ATTRIBUTE = re.compile(rb'\b([A-Za-z]+)="([^"<]*)"')  # from the beginning of a word: long ones are looked through once
ELEMENT = re.compile(rb"<(edge|lane|junction|connection|tlLogic|phase|location|roundabout|net|request)\b[^>]*>")
BOMB = b'<?xml version="1.0"?><!DOCTYPE net [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;">]><net>&b;</net>'
FETCH = b'<?xml version="1.0"?><!DOCTYPE net SYSTEM "file:///etc/passwd"><net/>'


@lru_cache(maxsize=2)
def _all(pattern: re.Pattern[bytes], text: bytes) -> list[re.Match[bytes]]:
    """Return all places of a pattern in a text: most mutations begin with the same one. Not to be changed."""
    return list(pattern.finditer(text))


def _attribute(text: bytes, rng: random.Random) -> bytes:
    found = rng.choice(_all(ATTRIBUTE, text))
    value = rng.choice(NASTY).encode().replace(b"&", b"").replace(b"<", b"")
    return text[: found.start(2)] + value + text[found.end(2) :]


def _other_value(text: bytes, rng: random.Random) -> bytes:
    one, other = (rng.choice(_all(ATTRIBUTE, text)) for _ in range(2))
    return text[: one.start(2)] + other[2] + text[one.end(2) :]


def _no_attribute(text: bytes, rng: random.Random) -> bytes:
    found = rng.choice(_all(ATTRIBUTE, text))
    return text[: found.start()] + text[found.end() :]


def _no_element(text: bytes, rng: random.Random) -> bytes:
    found = rng.choice(_all(ELEMENT, text))
    return text[: found.start()] + text[found.end() :]


def _twice(text: bytes, rng: random.Random) -> bytes:
    found = rng.choice(_all(ELEMENT, text))
    return text[: found.end()] + found[0] * rng.choice((1, 2, 50)) + text[found.end() :]


def _renamed(text: bytes, rng: random.Random) -> bytes:
    found = rng.choice(_all(ELEMENT, text))
    return text[: found.start(1)] + rng.choice((b"edge", b"x", b"lane", b"net")) + text[found.end(1) :]


def _all_of_one(text: bytes, rng: random.Random) -> bytes:
    key = rng.choice(sorted({found[1] for found in ATTRIBUTE.finditer(text)}))
    value = rng.choice(NASTY[:-10]).encode()
    return re.sub(rb"\b" + key + rb'="[^"]*"', key + b'="' + value + b'"', text)


def _cut(text: bytes, rng: random.Random) -> bytes:
    return text[: rng.randrange(len(text))]


def _bytes(text: bytes, rng: random.Random) -> bytes:
    changed = bytearray(text)
    for _ in range(rng.choice((1, 10, 1000))):
        changed[rng.randrange(len(changed))] = rng.randrange(256)
    return bytes(changed)


def _block_moved(text: bytes, rng: random.Random) -> bytes:
    start = rng.randrange(len(text))
    end = min(len(text), start + rng.randrange(2000))
    to = rng.randrange(len(text))
    return text[:to] + text[start:end] + text[to:]


def _whole(text: bytes, rng: random.Random) -> bytes:
    return rng.choice(
        (
            BOMB,
            FETCH,
            b"",
            b"\0" * 1000,
            b"<net>" + b"<a>" * 200_000,
            b"<net>" + b"<a/>" * 3_000_000 + b"</net>",
            b"<net><edge id='e' from='a' to='b'>" + b"<lane/>" * 1_000_000 + b"</edge></net>",
            b"<net " + b" ".join(b"a%d='1'" % number for number in range(100_000)) + b"/>",
            b'<?xml version="1.0" encoding="utf-7"?><net/>',
            b'<?xml version="1.0" encoding="x-nonsense"?><net/>',
            text.decode("latin-1").encode("utf-16"),
            b"<additional/>",
            b"<net>" + b"<edge id='" + b"e" * 5_000_000 + b"'/></net>",
        )
    )


MUTATIONS: tuple[Callable[[bytes, random.Random], bytes], ...] = (
    *(_attribute, _attribute, _attribute, _other_value, _no_attribute, _no_element, _twice, _renamed, _all_of_one),
    *(_cut, _bytes, _block_moved, _whole),
)


def mutated(text: bytes, rng: random.Random) -> bytes:
    """Return the network with one to three things wrong."""
    for _ in range(rng.choice((1, 1, 1, 2, 3))):
        if ATTRIBUTE.search(text) is None or ELEMENT.search(text) is None:
            break
        text = rng.choice(MUTATIONS)(text, rng)
    return text


def judged(content: bytes, seed: int) -> str:
    """Return what became of a map: refused, by one line, or loaded, with or without a report; all else is raised."""
    try:
        found = read_net(content, "strange.net.xml")
        profile = RoadsProfile(
            schema=1, title="", map=MapFile(name="strange.net.xml"), route=RandomRoute(seed=seed, length_m=300.0)
        )
        planned(profile, found)
    except ProfileError as error:
        text = str(error)
        assert text.startswith("strange.net.xml: "), text
        assert "\n" not in text, text
        assert text.isprintable(), ascii(text)
        assert len(text) < 600, text
        return "refused"
    return "loaded with a report" if found.report.skipped else "loaded"


def limit() -> None:
    """Let this program have as much memory as is promised, and no map more CPU time: the kernel ends a longer one."""
    _, most = resource.getrlimit(resource.RLIMIT_DATA)
    resource.setrlimit(resource.RLIMIT_DATA, (MEMORY_BYTES, most))
    signal.signal(signal.SIGPROF, _too_long)


def _too_long(number: int, frame: object) -> None:
    raise TimeoutError(f"a map took more than {CPU_S:g} s of CPU time")


def main(seed: int, count: int, path: str) -> None:
    """Read `count` mutations of the network at `path`."""
    limit()
    text, rng = Path(path).read_bytes(), random.Random(seed)
    judged(text, 0)
    counts: dict[str, int] = {}
    most_s = 0.0
    for number in range(count):
        content = mutated(text, rng)
        began = time.process_time()
        signal.setitimer(signal.ITIMER_PROF, CPU_S)
        outcome = judged(content, number)
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        most_s = max(most_s, time.process_time() - began)
        counts[outcome] = counts.get(outcome, 0) + 1
    # Of this program alone: ru_maxrss begins with what the program that started it had.
    status = Path("/proc/self/status").read_text()
    memory_mb = float(status.partition("VmHWM:")[2].split()[0]) / 1024.0
    print(json.dumps({"counts": counts, "most_cpu_s": most_s, "memory_mb": memory_mb}))


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]), sys.argv[3])
