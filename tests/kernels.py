"""Compile what most tests run, in a program of its own, while the processes that run tests collect them.

What a process compiles it keeps: some 200 MB that who loads the same from the cache never takes. Who needs a kernel
meanwhile waits until this program has compiled it (`values/host/jit`).
"""

import shutil
import tempfile
from pathlib import Path
from typing import Final

import numpy as np

from simconsole.profiles.files.loader import parse, profiles_folder
from simconsole.profiles.session import SessionProfile
from simconsole.session.lifecycle import drive, warm_up
from simconsole.session.resolution import load_session, resolve
from simconsole.tick.assembly import assemble
from simconsole.values.host.jit import compiled
from simconsole.vehicle.batch.fleet import Fleet
from tests.control.oracle_rules import COUNT
from tests.control.random_drives import SEED, random_drive
from tests.control.test_walk import VARIANTS, walked
from tests.control.walk import MODES
from tests.vehicle.driving import platform as hatchback
from tests.vehicle.fuzzing import on_tir

SESSION: Final = """\
schema: 1
environment: {world: WORLD}
scenario: {vehicle: VEHICLE, duration_s: 0.1}
devices: {driver: none}
outputs: {report: false}
mode: {tick_hz: 250, pacing: free}
"""
DRIVES: Final = (
    ("urban", "hatchback"),
    ("urban_signals, traffic: {pedestrians: 5, seed: 1}", "hatchback"),
    ("country", "hatchback"),
    ("arena", "turtlebot3_burger"),
    ("null", "ball"),
)
"""Worlds and vehicles whose ticks are compiled each by itself."""


def session_on_tir(folder: Path) -> Path:
    """Write the session of a car on a PAC2002 tyre."""
    vehicles = profiles_folder() / "vehicles"
    shutil.copy(vehicles / "tyres" / "example.tir", folder)
    (folder / "car.yaml").write_text((vehicles / "hatchback.yaml").read_text() + "tyre: {tir: example.tir}\n")
    session = folder / "session.yaml"
    session.write_text(SESSION.replace("WORLD", "urban").replace("VEHICLE", "car.yaml"))
    return session


def main() -> None:
    """Compile what a drive of each platform calls, and what only tests of `control` call.

    What cannot be compiled fails in the tests as well, which tell it better.
    """
    with tempfile.TemporaryDirectory() as folder:
        for number, (world, vehicle) in enumerate(DRIVES):
            text = SESSION.replace("WORLD", world).replace("VEHICLE", vehicle)
            resolved = resolve(parse(text, SessionProfile, "session"))
            warm_up(*assemble(resolved, compiled), awaited=True)
            drive(resolved, Path(folder) / str(number))
        warm_up(*assemble(resolve(load_session(str(session_on_tir(Path(folder))))), compiled))
    for platform in (on_tir(), hatchback()):
        Fleet([platform] * 2).step(1)
    random_drive(50, SEED, 100)
    walked(VARIANTS[0], {}, 100, SEED, np.zeros(MODES * COUNT * COUNT))


if __name__ == "__main__":
    main()
