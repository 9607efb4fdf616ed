"""How late the core's ticks are beside the driver's view, a camera on the bridge and a video being coded, and without.

Run: python benchmarks/view_lateness.py [--seconds S] [--rounds N] [--size WxH]

Real-time drives of the urban course in turns, each with a bridge: one alone; one with the view in a window, a client
that takes every picture of the camera, and `simconsole video` at work on an earlier drive. Lateness is that of all
ticks of a drive, as its manifest has it (bins of 12 %). The age is that of the newest tick when a frame begins. A
window needs a display: Xvfb is started where none is there.
"""

import argparse
import contextlib
import json
import os
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from statistics import median
from typing import Any

from simconsole.bridge.client.bridge_client import BridgeClient
from simconsole.bridge.console.camera_topics import IMAGE

TICK_HZ = 250
ALONE, BESIDE = "alone", "beside view, camera and video"
SESSION = """\
schema: 1
title: A drive to look at
environment: {{world: urban}}
scenario: {{vehicle: hatchback}}
outputs:
  bridge: {{port: {port}, camera: {camera}}}
  hud: {hud}
  scene: null
  sound: null
  report: false
devices: {{cockpit: t500rs_th8rs, driver: virtual}}
mode: {{pacing: realtime, tick_hz: 250}}
"""


def console(*words: object) -> list[str]:
    """Return a command line of the console."""
    return [sys.executable, "-m", "simconsole", *map(str, words)]


@contextlib.contextmanager
def display(size: tuple[int, int]) -> Iterator[dict[str, str]]:
    """Yield an environment with a display."""
    if os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"):
        yield dict(os.environ)
        return
    reading, writing = os.pipe()
    screen = f"{size[0]}x{size[1]}x24"
    command = ["Xvfb", "-displayfd", str(writing), "-screen", "0", screen, "-nolisten", "tcp"]
    with subprocess.Popen(command, pass_fds=[writing], stderr=subprocess.DEVNULL) as server:
        os.close(writing)
        try:
            with os.fdopen(reading) as file:
                yield {**os.environ, "DISPLAY": f":{file.readline().strip()}"}
        finally:
            server.terminate()


def free_port() -> int:
    """Return a port that nobody uses now."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


@contextlib.contextmanager
def taking_pictures(port: int) -> Iterator[list[int]]:
    """Take the camera's pictures meanwhile; yield a list of one number, how many came."""
    ended, count = threading.Event(), [0]

    def take() -> None:
        with BridgeClient(f"ws://127.0.0.1:{port}") as client:
            client.subscribe(IMAGE, "sensor_msgs/CompressedImage")
            while not ended.is_set():
                count[0] += client.receive(0.1) is not None

    thread = threading.Thread(target=take)
    thread.start()
    try:
        yield count
    finally:
        ended.set()
        thread.join()


@contextlib.contextmanager
def video_at_work(bundle: Path, folder: Path) -> Iterator[None]:
    """Code videos of a bundle meanwhile, one after the other."""
    ended = threading.Event()

    def code() -> None:
        while not ended.is_set():
            words = console("video", bundle, "--out", folder / "beside.mp4", "--size", "640x480")
            with subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as one:
                while one.poll() is None and not ended.wait(0.1):
                    pass
                one.terminate()

    thread = threading.Thread(target=code)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


def drive(folder: Path, size: tuple[int, int], seconds: float, environment: dict[str, str], *, seen: bool) -> Any:
    """Drive once; return the summary of its manifest, with how many pictures the camera's client took."""
    port = free_port()
    hud = f"{{width_px: {size[0]}, height_px: {size[1]}, view: {{}}}}" if seen else "null"
    folder.mkdir()
    session = folder / "session.yaml"
    session.write_text(SESSION.format(port=port, camera="{}" if seen else "null", hud=hud))
    words = console("drive", session, "--for", seconds, "--out", folder / "bundle", "--no-pack", "--json")
    with contextlib.ExitStack() as beside:
        count = [0]
        if seen:
            count = beside.enter_context(taking_pictures(port))
            beside.enter_context(video_at_work(folder.parent / "earlier", folder))
        done = subprocess.run(words, env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        raise SystemExit(done.stderr)
    manifest = json.loads((folder / "bundle" / "manifest.json").read_text())
    return {**manifest["summary"], "pictures": count[0]}


def main() -> None:
    """Print what is measured."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=30.0, help="of each drive")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--size", default="640x480", metavar="WxH", help="of the window")
    given = parser.parse_args()
    width, height = (int(number) for number in given.size.split("x"))
    late: dict[str, list[float]] = {ALONE: [], BESIDE: []}
    missing: list[str] = []
    with tempfile.TemporaryDirectory() as temporary, display((width, height)) as environment:
        folder = Path(temporary)
        earlier = console("drive", "seated", "--headless", "--driver", "virtual", "--for", 60, "--out")
        subprocess.run([*earlier, str(folder / "earlier")], check=True, capture_output=True)
        for number in range(given.rounds):
            for name, seen in ((ALONE, False), (BESIDE, True)):
                place = folder / f"{number}-{int(seen)}"
                summary = drive(place, (width, height), given.seconds, environment, seen=seen)
                late[name].append(summary["lateness_us"]["p50"])
                missing = summary["not_granted"]
                told = f"{name}: p50 {late[name][-1]:.0f} us, p99 {summary['lateness_us']['p99']:.0f} us"
                if seen:
                    age = summary["latency_us"]["receive, hud"]["p50"]
                    told += f"; newest tick {age / 1e3:.1f} ms old = {age * TICK_HZ / 1e6:.2f} ticks (p50)"
                    told += f"; {summary['pictures']} pictures of the camera"
                print(told, flush=True)
                time.sleep(1.0)
    ratio = median(late[BESIDE]) / median(late[ALONE])
    if missing:
        print(f"not granted here: {', '.join(missing)}")
    print(f"median lateness {ratio:.2f} times that without ({median(late[ALONE]):.0f} us; bar 1.3)")


if __name__ == "__main__":
    main()
