"""`simconsole turtlebot`: three robots map an arena, share tasks out and drive them, in lockstep over the WebSocket."""

import json
import os
import subprocess
import threading
import time
from argparse import Namespace
from pathlib import Path
from typing import Any

import msgspec

from simconsole.cli.driven import finish
from simconsole.cli.outcome import Outcome, table
from simconsole.cli.progress import Progress
from simconsole.evaluation.robots.mission_figure import mission_svg
from simconsole.evaluation.robots.mission_result import MissionResult, mission_result
from simconsole.processes.lifetimes import ATTACHED, end, spawn
from simconsole.profiles.parts.turtlebot import OdometryErrors, TurtlebotProfile
from simconsole.profiles.session import SessionProfile
from simconsole.recording.bundles.manifest import read_manifest
from simconsole.session.fleet.fleet_drive import drive_fleet
from simconsole.session.fleet.members import members
from simconsole.session.lifecycle import DriveResult
from simconsole.session.resolution import load_session, override, resolve
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.errors import ProfileError, WorkerError
from simconsole.world.arena.arena_world import ArenaWorld, arena_of
from simconsole.world.kinds.worlds import open_world

TABLE, FIGURE, RESULTS, BUNDLE = "table.txt", "mission.svg", "results.json", "bundle"
ERRORS = OdometryErrors(distance_scale=1.02, turn_scale=1.03, slip_m_per_root_m=0.002)
"""By which odometry errs: 2 % of the way, 3 % of the turn, and slip."""
PATIENCE_S = 60.0
"""How long the program tries to connect, and how long it may take to write down what it did."""


def turtlebot(options: Namespace) -> Outcome:
    """Map, allocate, drive; code 1 where a task was not done or a robot touched something.

    Raises:
        ProfileError: the session has no platforms, or not in an arena.
        WorkerError: the program has ended without a result.
    """
    began_s = sum(os.times()[:4])
    folder = Path(options.out) if options.out else Path("out") / time.strftime("turtlebot-%Y%m%d-%H%M%S")
    resolved = _resolved(options.session, options.seed, options.fail)
    arena = _arena(resolved)
    with Progress("robots") as progress:
        driven = _driven(resolved, folder, options.objective, progress)
    result = mission_result(folder, driven.folder, arena)
    (folder / TABLE).write_text(result.text(), "utf-8")
    (folder / FIGURE).write_text(mission_svg(result, arena), "utf-8")
    outcome = finish(driven, packed=not options.no_pack)
    cpu_s = sum(os.times()[:4]) - began_s
    digests = {next(iter(members(resolved))): driven.digest, **read_manifest(driven.folder).platforms}
    plain = {
        **result.plain(),
        "folder": str(folder),
        "digests": digests,
        "cpu_s": cpu_s,
        "simulated_s": _seconds(driven),
    }
    (folder / RESULTS).write_text(json.dumps(plain, indent=1) + "\n", "utf-8")
    code = outcome.code or (0 if result.good else 1)
    return Outcome(code, plain, _text(result, plain, folder))


def _seconds(driven: DriveResult) -> float:
    return float(driven.summary["wall_s"] * driven.summary["real_time_factor"])


def _text(result: MissionResult, plain: dict[str, Any], folder: Path) -> str:
    files = ", ".join((TABLE, FIGURE, RESULTS, "map.yaml", "map.pgm"))
    rows = [
        (
            "done",
            "all tasks, nobody touched anything" if result.good else "NOT all tasks, or somebody touched something",
        ),
        ("explored", f"in {result.log.explored_s or 0.0:.1f} s, all in {plain['simulated_s']:.1f} s simulated"),
        ("planned", f"{plain['planned_m']:.2f} m, driven {plain['driven_m']:.2f} m"),
        ("processor", f"{plain['cpu_s']:.1f} s"),
        ("bundle", str(folder / BUNDLE)),
        ("beside it", files),
    ]
    return f"{result.text()}\n{table(rows)}"


def _resolved(name: str, seed: int, fail: tuple[str, float] | None) -> ResolvedSession:
    """Return the session with errors drawn from the seed, on a port that the system chooses; one robot may fail."""
    session = load_session(name)
    if not session.scenario.platforms or session.outputs.bridge is None:
        raise ProfileError(f"{name}: scenario.platforms: value missing: the robots of the team, and outputs.bridge")
    if fail is not None:
        session = failing(session, *fail)
    bridge = msgspec.to_builtins(session.outputs.bridge)
    changed = {**bridge, "port": 0, "link": {**bridge["link"], "seed": seed}}
    resolved = resolve(override(session, outputs={"bridge": changed}, mode={"answer_timeout_s": PATIENCE_S}))
    errors = msgspec.structs.replace(ERRORS, seed=seed + 1)
    fleet = tuple(
        msgspec.structs.replace(robot, odometry=errors) if isinstance(robot, TurtlebotProfile) else robot
        for robot in resolved.fleet
    )
    return msgspec.structs.replace(resolved, fleet=fleet)


def failing(session: SessionProfile, robot: str, at_s: float) -> SessionProfile:
    """Return the session with a robot that hears no command from a time on: it is that of the seat, which has faults.

    Raises:
        ProfileError: there is no such robot, or another one has the session's faults.
    """
    scenario = session.scenario
    if scenario.faults and robot != (scenario.seat or scenario.platforms[0].name):
        raise ProfileError(f"--fail: value {robot}: the robot of scenario.seat, which has faults already")
    faults = [*msgspec.to_builtins(scenario.faults), {"kind": "silent", "at_s": at_s}]
    return override(session, scenario={"seat": robot, "faults": faults})


def _arena(resolved: ResolvedSession) -> ArenaWorld:
    arena = None if resolved.world is None else arena_of(open_world(resolved.world))
    if arena is None or not arena.profile.targets:
        raise ProfileError("environment.world: an arena with targets, which are the tasks")
    return arena


def _driven(resolved: ResolvedSession, folder: Path, objective: str, progress: Progress) -> DriveResult:
    """Drive, with the program on the ROS side beside it."""
    started: list[subprocess.Popen[bytes]] = []
    readers: list[threading.Thread] = []
    tasks = len(_arena(resolved).profile.targets)

    def start(url: str) -> None:
        program = spawn(_arguments(resolved, url, folder, objective), stdout=subprocess.PIPE)
        started.append(program)
        readers.append(threading.Thread(target=_follow, args=(program, tasks, progress), daemon=True))
        readers[0].start()

    try:
        driven = drive_fleet(
            resolved,
            folder / BUNDLE,
            until_left=True,
            on_bridge=start,
        )
        try:
            code = started[0].wait(PATIENCE_S)
        except subprocess.TimeoutExpired:
            raise WorkerError(f"the robots' program has not ended {PATIENCE_S:g} s after the drive") from None
    finally:
        end(started, 0.3)
    readers[0].join()
    if code:
        raise WorkerError(f"the robots' program has ended with exit code {code}")
    return driven


def _arguments(resolved: ResolvedSession, url: str, folder: Path, objective: str) -> list[str]:
    session = resolved.session
    arguments = ["-m", "simconsole.drivers.robots.nodes.program", "team", ATTACHED, "--lockstep", "--url", url]
    arguments += ["--arena", session.environment.world or "", "--objective", objective]
    arguments += ["--out", str(folder), "--wait", f"{PATIENCE_S:g}"]
    for part in members(resolved).values():
        bridge, start = part.session.outputs.bridge, part.session.scenario.start
        assert bridge is not None
        assert start is not None
        vehicle = part.session.scenario.vehicle
        place = f"{start.x_m:.6f},{start.y_m:.6f},{start.yaw_deg:.6f}"
        arguments += ["--robot", f"{bridge.namespace}={vehicle}@{place}"]
    return arguments


def _follow(program: "subprocess.Popen[bytes]", tasks: int, progress: Progress) -> None:
    """Show how far the program is, by the lines that it writes."""
    assert program.stdout is not None
    for line in program.stdout:
        told = json.loads(line)
        if "done" in told:
            progress.done("exploring" if told["explored"] is None else "tasks", told["done"] / tasks)
