"""The commands that drive, and those beside a drive."""

import os
from typing import Any, Final

from simconsole.cli.arguments.subparser import actions, command, number
from simconsole.cli.terminal.parser import Parser
from simconsole.drivers.path_tracker.tracker_settings import GATE, TRACKERS
from simconsole.processes.lifetimes import ATTACHED

_MAX_DELAY_MS: Final = 6000.0
"""The longest delay that a session's link may have each way, and its jitter on average."""
_ACTS: Final = {
    "start": "go on with simulated time, or begin a session that waits for it",
    "pause": "let simulated time stand",
    "restart": "put the car back to the start",
    "autonomous": "ask for the automatic drive, as from the wheel",
    "manual": "ask for the drive by the person, as from the wheel",
    "shared": "ask for shared control, as from the wheel",
    "takeover": "ask the person to take over",
    "fault": "begin the scenario's faults that wait for it",
    "mark": "put a mark into the recording",
    "reset": "release the emergency stop of a standing vehicle",
    "estop": "stop at once",
    "anti_lock": "switch the anti-lock brakes off, or on again",
    "traction": "switch traction control off, or on again",
    "stability": "switch stability control off, or on again",
}
_OPERATED: Final = {"mark": ('--note "deer on the road"', "--participant P07 --trial B-3")}


def driving(commands: Any) -> None:
    """Add demo, drive, check, scenario, turtlebot and sweep."""
    _demo_and_drive(commands)
    _check(commands)
    _scenario(commands)
    _turtlebot(commands)
    _sweep(commands)


def _demo_and_drive(commands: Any) -> None:
    demo = command(
        commands,
        "demo",
        "demo:demo",
        "the whole way once, with no hardware: person, autopilot, report",
        "",
        "--perfect --out out/first",
    )
    demo.add_argument("--perfect", action="store_true", help="exact odometry and no delay on the autopilot's link")
    demo.add_argument("--sumo", action="store_true", help="among SUMO's traffic, by SUMO's signals (extra `sumo`)")
    demo.add_argument("--realtime", action="store_true", help="pace it, with every worker in its own process")
    demo.add_argument("--out", metavar="DIR", help="where the bundle goes (default: out/demo-TIME)")

    drive = command(
        commands,
        "drive",
        "drive:drive",
        "drive a session",
        "",
        "demo --headless --for 30",
        "--driver keyboard",
        "seated --choose",
    )
    drive.add_argument(
        "session", nargs="?", default="seated", metavar="SESSION", help="by name, or a .yaml file (default: seated)"
    )
    drive.add_argument("--headless", action="store_true", help="no window, as fast as it goes")
    drive.add_argument("--choose", action="store_true", help="ask what to drive with, and where")
    drive.add_argument("--driver", metavar="D", help="sdl | virtual | trace:F | script:F | keyboard | none")
    drive.add_argument("--person", type=int, metavar="SEED", help="with the driver virtual: which simulated person")
    drive.add_argument("--commands", metavar="C", help="bag:FILE[:TOPIC]: recorded commands in place of a controller's")
    drive.add_argument("--cockpit", metavar="PROFILE", help="a cockpit by name, or the file that `calibrate` wrote")
    drive.add_argument("--language", metavar="L", help="of the display: english, german, or a .yaml file")
    drive.add_argument("--for", dest="duration_s", type=float, metavar="S", help="end after S simulated seconds")
    drive.add_argument("--out", metavar="DIR", help="where the bundle goes (default: out/drive-TIME)")
    drive.add_argument("--participant", default="", metavar="ID", help="who drives; kept in the bundle from the start")
    drive.add_argument("--trial", default="", metavar="ID", help="which of their drives")
    drive.add_argument("--note", action="append", default=[], metavar="TEXT", help="may be given several times")
    for one in (demo, drive):
        one.add_argument("--no-pack", action="store_true", help="leave the log as it was written")


def _check(commands: Any) -> None:
    check = command(
        commands,
        "check",
        "check:check",
        "drive scripted scenarios headless against their goldens",
        "launch_and_stop emergency_stop",
        'profiles/scenarios -k "hand_over and not lost" --jobs 2',
    )
    check.add_argument("scenarios", nargs="+", metavar="SCENARIO", help="by name, a .yaml file, or a folder")
    check.add_argument(
        "-k", dest="select", metavar="EXPR", help="only those whose path has these words: hills and not van"
    )
    check.add_argument("--jobs", type=int, default=1, metavar="N", help="drive N at a time")
    check.add_argument("--report", metavar="FILE", help="write values and plots of the test manoeuvres as HTML")
    check.add_argument("--junit", metavar="FILE", help="write a JUnit report")
    check.add_argument("--review", metavar="FILE", help="write accepted and driven over each other, where they differ")
    check.add_argument("--update-golden", action="store_true", help="accept what was driven as the new golden")


def _scenario(commands: Any) -> None:
    scenario = command(
        actions(commands, "scenario", "scenarios of other formats"),
        "import",
        "scenarios.importing:scenario",
        "make a scenario of an OpenSCENARIO file",
        "cut_in.xosc --partly",
    )
    scenario.add_argument("name", metavar="FILE", help="OpenSCENARIO XML 1.x, .xosc")
    scenario.add_argument("--ego", metavar="ENTITY", help="the console's vehicle (default: the one called ego or hero)")
    scenario.add_argument("--vehicle", default="hatchback", metavar="PROFILE", help="what it is driven as")
    scenario.add_argument(
        "--lane-width", type=number(1.0, 10.0, "m"), default=3.5, metavar="M", help="of the road (3.5)"
    )
    scenario.add_argument(
        "--parameter", action="append", default=[], metavar="NAME=VALUE", help="of those that the file declares"
    )
    scenario.add_argument(
        "--values", metavar="FILE", help="of parameters, .xosc: a scenario for each set of them, and their sweep's plan"
    )
    scenario.add_argument("--partly", action="store_true", help="leave out what is not understood, and list it")
    scenario.add_argument(
        "--out", metavar="FILE", help="the scenario (default: its name here, .yaml); with --values a folder"
    )


def _turtlebot(commands: Any) -> None:
    robots = command(
        commands,
        "turtlebot",
        "turtlebot.turtlebot_command:turtlebot",
        "three robots: map, share tasks out, drive",
        "",
        "--objective makespan",
    )
    robots.add_argument("--session", default="turtlebot3_team", metavar="SESSION", help="with platforms, in an arena")
    robots.add_argument("--seed", type=int, default=0, metavar="N", help="of the errors of lidar and odometry")
    robots.add_argument(
        "--objective", choices=("sum", "makespan"), default="sum", help="what the allocation makes least (default: sum)"
    )
    robots.add_argument(
        "--fail", type=_failure, metavar="NAME@SECONDS", help="this robot fails then: the others do its open tasks"
    )
    robots.add_argument("--out", metavar="DIR", help="where all goes (default: out/turtlebot-TIME)")
    robots.add_argument("--no-pack", action="store_true", help="leave the logs as they were written")


def _failure(text: str) -> tuple[str, float]:
    name, _, time_s = text.partition("@")
    return name, number(0.0, 86_400.0, "s")(time_s)


def _sweep(commands: Any) -> None:
    sweep = command(
        commands,
        "sweep",
        "sweep.sweep_command:sweep",
        "many drives of one plan into one table",
        "plan.yaml --jobs 2",
        "plan.yaml --drive 17",
    )
    sweep.add_argument("plan", metavar="PLAN", help="a .yaml file: sessions or scenarios, values, seeds")
    sweep.add_argument("--jobs", type=int, default=os.cpu_count() or 1, metavar="N", help="processes (default: cores)")
    sweep.add_argument("--engine", choices=("local", "dask"), default="local", help="where: here, or Dask's workers")
    sweep.add_argument("--scheduler", metavar="URL", help="of Dask: tcp://HOST:8786 (extra `dask`)")
    sweep.add_argument("--drive", type=int, metavar="INDEX", help="only this one, into a bundle")
    sweep.add_argument(
        "--out", metavar="DIR", help="its folder (default: out/sweep-PLAN); one that was cut off there goes on"
    )


def beside_a_drive(commands: Any) -> None:
    """Add operate and autopilot."""
    acts = actions(commands, "operate", "an operator's act in a running drive", "act")
    for act, summary in _ACTS.items():
        _operate(command(acts, act, "operate:operate", summary, *_OPERATED.get(act, ("",))))
    autopilot = command(
        commands,
        "autopilot",
        "remote:autopilot",
        "the path tracker, as a ROS-side program",
        "",
        "--course urban --plan-hz 5",
    )
    autopilot.add_argument("--url", default="ws://127.0.0.1:9090", metavar="URL", help="the rosbridge server")
    autopilot.add_argument("--course", default="urban", metavar="WORLD", help="whose route it follows")
    autopilot.add_argument("--vehicle", default="hatchback", metavar="VEHICLE", help="the car that it drives")
    autopilot.add_argument(
        "--delay-ms", type=number(0.0, _MAX_DELAY_MS, "ms"), default=10.0, metavar="MS", help="from state to effect"
    )
    autopilot.add_argument("--tracker", choices=TRACKERS, default=TRACKERS[0], help="how it steers")
    autopilot.add_argument(
        "--lateral-accel",
        type=number(0.1, 20.0, "m/s2"),
        default=GATE.lateral_mps2,
        metavar="MPS2",
        help="that the console's gate lets pass",
    )
    autopilot.add_argument(
        "--lateral-jerk",
        type=number(0.0, 100.0, "m/s3"),
        default=GATE.lateral_jerk_mps3,
        metavar="MPS3",
        help="the same; 0: any",
    )
    autopilot.add_argument("--plan-hz", type=number(0.0, 20.0, "Hz"), default=0.0, help="how often it tells its plan")
    autopilot.add_argument("--speed-advice", action="store_true", help="come to lights at green where speed can do it")
    autopilot.add_argument("--wait", type=float, default=10.0, metavar="S", help="how long to wait for the server")
    autopilot.add_argument(
        "--namespace", action="append", default=[], metavar="NS", help="of the car's topics; again: of a further car"
    )
    autopilot.add_argument("--rename", action="append", default=[], metavar="/TOPIC=/NAME", help="what one is called")
    autopilot.add_argument("--certificate", metavar="PEM", help="of a wss:// server; a token: SIMCONSOLE_TOKEN")
    autopilot.add_argument(ATTACHED, action="store_true", help="end with whoever holds standard input")


def _operate(operate: Parser) -> None:
    operate.add_argument("--note", default="", metavar="TEXT", help="kept with the drive")
    operate.add_argument("--participant", default="", metavar="ID", help="kept with the drive: who drives")
    operate.add_argument("--trial", default="", metavar="ID", help="kept with the drive: which of their drives")
    operate.add_argument(
        "--url",
        default="ws://127.0.0.1:9090",
        metavar="URL",
        help="the console's rosbridge server (a token of role control, if it asks for one: SIMCONSOLE_TOKEN)",
    )
    operate.add_argument("--namespace", default="", metavar="NS", help="of the console's topics")
