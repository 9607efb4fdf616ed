"""Compile what most tests run, in a program of its own, while the processes that run tests collect them.

What a process compiles it keeps: some 200 MB that who loads the same from the cache never takes. Who needs a kernel
meanwhile waits until this program has compiled it (`values/host/jit`).
"""

from typing import Final

import numpy as np

from simconsole.profiles.files.loader import parse
from simconsole.profiles.session import SessionProfile
from simconsole.session.lifecycle import warm_up
from simconsole.session.resolution import resolve
from simconsole.tick.assembly import assemble
from simconsole.values.host.jit import compiled
from tests.control.oracle_rules import COUNT
from tests.control.random_drives import SEED, random_drive
from tests.control.test_walk import VARIANTS, walked
from tests.control.walk import MODES

SESSION: Final = """\
schema: 1
environment: {world: WORLD}
scenario: {vehicle: VEHICLE}
devices: {driver: none}
mode: {tick_hz: 250, pacing: free}
"""
TICKS: Final = (
    ("urban", "hatchback"),
    ("urban_signals, traffic: {seed: 1}", "hatchback"),
    ("country", "hatchback"),
    ("arena", "turtlebot3_burger"),
)
"""Worlds and vehicles whose ticks are compiled each by itself."""


def main() -> None:
    """Compile the tick of each platform, and what only tests of `control` call.

    What cannot be compiled fails in the tests as well, which tell it better.
    """
    for world, vehicle in TICKS:
        text = SESSION.replace("WORLD", world).replace("VEHICLE", vehicle)
        warm_up(*assemble(resolve(parse(text, SessionProfile, "session")), compiled))
    random_drive(50, SEED, 100)
    walked(VARIANTS[0], {}, 100, SEED, np.zeros(MODES * COUNT * COUNT))


if __name__ == "__main__":
    main()
