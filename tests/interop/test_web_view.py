"""examples/web_view in a browser: the page follows a drive of ours, and its picture shows the road."""

import hashlib
import json
import math
import shutil
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection

from simconsole.profiles.files.world_files import load_world
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.world.kinds.worlds import route_points
from tests.interop.browser import CHROMIUM, Page, browse
from tests.interop.programs import CACHE, client, environment, program, wait_for_port
from tests.paths import ROOT
from tests.patience import PATIENCE_S, wait_until
from tests.ports import free_port

EXAMPLE = ROOT / "examples" / "web_view"
NPM = shutil.which("npm")
SAMPLES = 10
DRAWS = "{ const next = requestAnimationFrame; requestAnimationFrame = (draw) => setTimeout(() => next(draw), 100); }"
"""The browser draws some ten pictures a second: the processor paints them, and from one to the next the car turns."""
MET_M, MET_RAD = 0.01, 0.002
"""How far the page's car may be from the recorded one at the moment that the page says it shows."""
SIZE_PX = (400, 300)
SKY = (0xA9, 0xC4, 0xDC)

pytestmark = [
    pytest.mark.skipif(NPM is None, reason="no npm: system-packages.txt"),
    pytest.mark.skipif(CHROMIUM is None, reason="no Chromium: system-packages.txt"),
]


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page, built by the command that its README names; npm fetches the libraries once."""
    lock = hashlib.sha256((EXAMPLE / "package-lock.json").read_bytes()).hexdigest()[:16]
    libraries = CACHE / f"web_view-{lock}"
    if not (libraries / "node_modules" / "three").exists():
        libraries.mkdir(parents=True, exist_ok=True)
        for name in ("package.json", "package-lock.json", ".npmrc"):
            shutil.copy(EXAMPLE / name, libraries)
        npm(libraries, "ci", "--ignore-scripts")
    folder = tmp_path_factory.mktemp("web_view")
    ignored = shutil.ignore_patterns("node_modules", "dist")
    shutil.copytree(EXAMPLE, folder, ignore=ignored, dirs_exist_ok=True)
    (folder / "node_modules").symlink_to(libraries / "node_modules")
    npm(folder, "run", "build")
    return folder / "dist"


def npm(folder: Path, *words: str) -> None:
    done = subprocess.run([str(NPM), *words], cwd=folder, capture_output=True, text=True, timeout=PATIENCE_S)
    assert done.returncode == 0, done.stderr


class Ear:
    """Hears /view/hud beside the page, and asks for things."""

    def __init__(self, web: ClientConnection) -> None:
        self._web = web
        for operation in (
            {"op": "subscribe", "topic": "/view/hud", "queue_length": 1000},
            {"op": "advertise", "topic": "/console/request", "type": "std_msgs/String"},
        ):
            self._web.send(json.dumps(operation))
        self.readings: dict[float, dict[str, Any]] = {}
        """By stamp in s."""
        self.newest: dict[str, Any] = {}
        self._thread = threading.Thread(target=self._listen, daemon=True)
        self._thread.start()

    def ask(self, word: str) -> None:
        self._web.send(json.dumps({"op": "publish", "topic": "/console/request", "msg": {"data": word}}))

    def drive_until(self, condition: Callable[[dict[str, Any]], bool], what: str, word: str = "") -> None:
        """Have the autopilot drive, and ask it for `word`, until a reading fulfils a condition.

        A starved machine stops a car whose controller is silent: then it is asked to drive on.
        """
        asked_s = -1.0

        def there() -> bool:
            nonlocal asked_s
            newest_s = next(reversed(self.readings), 0.0)
            if self.newest and condition(self.newest):
                return True
            if self.newest and newest_s > asked_s + 0.5:
                asked_s = newest_s
                mode = self.newest["mode_words"]
                if mode != "AUTONOMOUS":
                    self.ask("autonomous" if mode == "PARKED" else "reset")
                elif word:
                    self.ask(word)
            return False

        wait_until(there, what)

    def _listen(self) -> None:
        try:
            for text in self._web:
                message = json.loads(text)
                if message["op"] == "publish":
                    stamp = message["msg"]["header"]["stamp"]
                    self.readings[stamp["sec"] + 1e-9 * stamp["nanosec"]] = self.newest = message["msg"]
        except ConnectionClosed:
            return


@contextmanager
def drive(folder: Path, port: int) -> Iterator["subprocess.Popen[str]"]:
    """The sample's own session, on a port of the test's."""
    session = yaml.safe_load((EXAMPLE / "session.yaml").read_text())
    session["outputs"]["bridge"]["port"] = port
    session["scenario"]["start"] = before_a_bend()
    path = folder / "session.yaml"
    path.write_text(yaml.safe_dump(session))
    words = ("-m", "simconsole", "drive", str(path), "--out", str(folder / "bundle"), "--no-pack")
    with program(environment(), sys.executable, *words) as process:
        wait_for_port(port)
        yield process


def before_a_bend() -> dict[str, float]:
    """Where the course's sharpest bend lies some 20 m ahead; the route has a point every 2 m."""
    points = np.array(route_points(load_world("urban")))
    turned = np.abs(np.diff(np.unwrap(points[:, 2]), prepend=points[0, 2]))
    x_m, y_m, yaw_rad = points[max(0, int(turned.argmax()) - 10)].tolist()
    return {"x_m": x_m, "y_m": y_m, "yaw_deg": math.degrees(math.remainder(yaw_rad, math.tau))}


@contextmanager
def served(folder: Path) -> Iterator[int]:
    """A folder over HTTP: the port."""

    class Quiet(SimpleHTTPRequestHandler):
        def log_request(self, code: int | str = "-", size: int | str = "-") -> None:
            pass

    with ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(folder))) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield int(server.server_address[1])
        server.shutdown()


MOTION = """
import { Motion } from "./src/motion.js";
const motion = new Motion(), seen = [];
for (const [kind, now, stamp] of JSON.parse(process.argv[1])) {
  if (kind === "take") {
    const header = { stamp: { sec: 0, nanosec: Math.round(1e9 * stamp) }, frame_id: "map" };
    const transform = { translation: { x: 10 * stamp, y: 0, z: 0 }, rotation: { x: 0, y: 0, z: 0, w: 1 } };
    motion.take({ transforms: [{ header, child_frame_id: "base_link", transform }] }, now);
  } else {
    const { time, frames } = motion.at(now);
    seen.push([time, frames.get("base_link").place.x]);
  }
}
console.log(JSON.stringify(seen));
"""


def moved(built: Path, happened: list[tuple[Any, ...]]) -> list[tuple[float, float]]:
    """Simulated time and place, at 10 m/s, of each `("at", now)` between the messages `("take", now, stamp)`."""
    words = [str(shutil.which("node")), "--input-type=module", "--eval", MOTION, json.dumps(happened)]
    done = subprocess.run(words, cwd=built.parent, capture_output=True, text=True, timeout=PATIENCE_S)
    assert done.returncode == 0, done.stderr
    return [(time, place) for time, place in json.loads(done.stdout)]


def test_messages_that_come_unevenly_are_drawn_evenly(built: Path) -> None:
    jitter = np.random.Generator(np.random.PCG64(3)).uniform(0.0, 0.008, 100).tolist()
    comes = [("take", 100.0 + 0.02 * n + late, 0.02 * n) for n, late in enumerate(jitter, 1)]
    looks = [("at", 100.5 + 0.0037 * n) for n in range(300)]
    seen = moved(built, sorted((*comes, *looks), key=lambda one: float(one[1])))
    steps = np.diff([time for time, _ in seen])
    assert (steps >= 0.0).all()
    assert steps.max() < 0.0037 + 0.008 + 0.001
    assert [place for _, place in seen] == pytest.approx([10.0 * time for time, _ in seen])


def test_nothing_is_drawn_beyond_the_newest_pose_and_a_new_drive_begins_at_its_start(built: Path) -> None:
    seen = moved(
        built,
        [
            *(("take", 100.0, 1.0), ("at", 100.0), ("take", 100.02, 1.02), ("at", 100.03), ("at", 107.0)),
            *(("take", 107.0, 1.04), ("at", 107.0), ("take", 107.02, 1.06), ("at", 107.035)),  # after a pause
            *(("take", 108.0, 0.02), ("at", 108.0)),  # another drive
        ],
    )
    assert [time for time, _ in seen] == pytest.approx([1.0, 1.01, 1.02, 1.04, 1.055, 0.02])


OTHERS = """
import { Group, Mesh, MeshStandardMaterial } from "three";
import { Others } from "./src/others.js";
const map = new Group(), others = new Others(map), seen = [];
for (const users of JSON.parse(process.argv[1])) {
  others.takeUsers({ users });
  seen.push(map.children.map((box) => [...box.position.toArray(), ...box.scale.toArray()]));
}
const lamps = ["red", "amber", "green"].map((name) => {
  const lamp = new Mesh(undefined, new MeshStandardMaterial());
  return Object.assign(lamp, { name: `signal_0_${name}`, userData: { signal: "a", link: 1 } });
});
for (const state of [3, 4, 6, 8, 1]) {
  others.takeSignals({ signals: [{ id: "b", states: [3, 3] }, { id: "a", states: [6, state] }] }, lamps);
  seen.push(lamps.map(({ material }) => material.emissive.getHex() !== 0));
}
console.log(JSON.stringify(seen));
"""


def test_others_are_boxes_on_the_road_and_lamps_shine(built: Path) -> None:
    still = {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}

    def user(number: int, x_m: float) -> dict[str, Any]:
        place = {"position": {"x": x_m, "y": 2.0, "z": 1.0}, "orientation": still}
        return {"id": number, "kind": 1, "pose": place, "size": {"x": 4.4, "y": 1.8, "z": 1.5}}

    told = json.dumps([[user(1, 10.0), user(2, 20.0)], [user(2, 21.0)]])
    words = [str(shutil.which("node")), "--input-type=module", "--eval", OTHERS, told]
    done = subprocess.run(words, cwd=built.parent, capture_output=True, text=True, timeout=PATIENCE_S)
    assert done.returncode == 0, done.stderr
    first, second, *lamps = json.loads(done.stdout)
    assert first == [[10.0, 2.0, 1.75, 4.4, 1.8, 1.5], [20.0, 2.0, 1.75, 4.4, 1.8, 1.5]]
    assert second == [[21.0, 2.0, 1.75, 4.4, 1.8, 1.5]]
    red, amber, green, dark = [True, False, False], [False, True, False], [False, False, True], [False] * 3
    assert lamps == [red, [True, True, False], green, amber, dark]


def shown(page: Page) -> dict[str, Any]:
    """What the page says it shows."""
    state: dict[str, Any] | None = page.value("globalThis.view?.()")
    return state or {}


def test_the_page_follows_a_drive(built: Path, tmp_path: Path, record_property: Any) -> None:
    port = free_port()
    (tmp_path / "browser").mkdir()
    with drive(tmp_path, port) as process, served(built) as web:
        url = f"http://127.0.0.1:{web}/?host=127.0.0.1:{port}"
        with client(f"ws://127.0.0.1:{port}") as heard, browse(url, tmp_path / "browser", *SIZE_PX, DRAWS) as page:
            ear = Ear(heard.web)
            wait_until(lambda: shown(page).get("parts") and "base_link" in shown(page)["poses"], "the car in the scene")
            picture = page.screenshot()
            states = under_way(ear, page)
            ear.drive_until(lambda read: read["mode_words"] == "TAKE OVER", "a take-over", "takeover")
            alert = alerted(page)
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=PATIENCE_S)
            wait_until(lambda: shown(page)["hud"]["mode"] == "NO DATA", "no data")
            complaints = [one for one in page.complaints if "WebSocket" not in str(one) and "GPU stall" not in str(one)]
    assert complaints == []
    has_all_parts(states[-1]["parts"])
    for state in (*states, alert):
        reads_as_told(state["hud"], ear.readings[state["hud"]["stamp"]])
    assert alert["hud"]["alert"] == f"TAKE OVER {math.ceil(ear.readings[alert['hud']['stamp']]['takeover_remaining'])}"
    met = follows(states, tmp_path / "bundle")
    record_property("web view", f"pose met within {1000.0 * met:.1f} mm in {SAMPLES} pictures")
    shows_a_road(picture, tmp_path)


def under_way(ear: Ear, page: Page) -> list[dict[str, Any]]:
    """What it shows in a bend; again where a starved machine has stopped the car meanwhile."""
    while True:
        ear.drive_until(lambda read: abs(read["hand_wheel"]) > 0.5 and read["speed"] > 2.0, "a bend")
        states = frames(page)
        if all(state["hud"]["mode"] == "AUTONOMOUS" for state in states):
            return states


def alerted(page: Page) -> dict[str, Any]:
    """What it shows when it first asks to take over."""
    state: dict[str, Any] = {}

    def asks() -> bool:
        state.update(shown(page))
        return bool(state["hud"]["alert"].startswith("TAKE OVER"))

    wait_until(asks, "the alert")
    return state


def frames(page: Page) -> list[dict[str, Any]]:
    """What it shows in some pictures, one after another."""
    found: list[dict[str, Any]] = []
    while len(found) < SAMPLES:
        state = shown(page)
        if not found or state["frames"] > found[-1]["frames"]:
            found.append(state)
    return found


def has_all_parts(parts: list[str]) -> None:
    still = {
        "land",
        "asphalt",
        "markings",
        "crossings",
        "stop_lines",
        "kerbs",
        "signs",
        "buildings",
        "trees",
        "signals",
    }
    moving = {"body", "front_left_wheel", "front_right_wheel", "rear_left_wheel", "rear_right_wheel", "hand_wheel"}
    assert still | moving <= set(parts)
    assert sum(name.startswith("signal_") for name in parts) == 12


def reads_as_told(text: dict[str, Any], told: dict[str, Any]) -> None:
    assert text["speed"] == str(told["shown_speed"])
    assert text["gear"] == ("A " if told["automatic"] else "") + told["gear"]
    assert text["mode"] == told["mode_words"]
    assert text["reason"] == (told["todo_words"] or told["reason_words"])
    assert text["limit"] == "limit 50"
    assert text["authority"] == "AUTOPILOT"


def follows(states: list[dict[str, Any]], bundle: Path) -> float:
    """Assert that the page's car is where the recorded one was; return the largest distance in m."""
    log = open_bundle(bundle).log.table(("vehicle.x_m", "vehicle.y_m", "vehicle.yaw_rad", "vehicle.road_wheel_rad"))
    times = log.ticks / log.tick_hz
    worst = 0.0
    for state in states:
        assert state["older"] <= state["time"] <= state["newer"]
        x, y, yaw, steer = (float(np.interp(state["time"], times, log.column(name))) for name in log.columns)
        px, py, _, *turn = state["poses"]["base_link"]
        worst = max(worst, math.hypot(px - x, py - y))
        assert abs(math.remainder(yaw_of(turn) - yaw, math.tau)) < MET_RAD
        left, rear = (state["poses"][name] for name in ("front_left_wheel", "rear_left_wheel"))
        assert abs(axle_yaw(left[3:]) - steer) < MET_RAD
        assert abs(axle_yaw(rear[3:])) < MET_RAD
        assert left[0] == pytest.approx(2.5, abs=0.5)
    assert worst < MET_M
    first, last = states[0], states[-1]
    turned = math.remainder(yaw_of(last["poses"]["base_link"][3:]) - yaw_of(first["poses"]["base_link"][3:]), math.tau)
    assert abs(turned) > 0.05
    assert last["time"] > first["time"]
    assert last["frames"] > first["frames"]
    assert first["poses"]["base_link"][0] != last["poses"]["base_link"][0]
    assert first["poses"]["rear_left_wheel"][3:] != last["poses"]["rear_left_wheel"][3:]
    return worst


def yaw_of(turn: list[float]) -> float:
    x, y, z, w = turn
    return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def axle_yaw(turn: list[float]) -> float:
    """The yaw of the y axis of a wheel, which its rolling leaves alone."""
    x, y, z, w = turn
    return math.atan2(-2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z))


def shows_a_road(png: bytes, folder: Path) -> None:
    """Sky above, asphalt below, and much in between; not one colour everywhere."""
    from matplotlib.image import imread

    path = folder / "web_view.png"
    path.write_bytes(png)
    pixels = np.rint(255.0 * imread(path)[:, :, :3]).astype(int)
    height = len(pixels)
    above, below = pixels[: height // 2].reshape(-1, 3), pixels[height // 2 : height * 3 // 4].reshape(-1, 3)
    assert (np.abs(above - SKY).max(axis=1) < 8).mean() > 0.02
    dark_grey = (np.ptp(below, axis=1) < 12) & (below.max(axis=1) > 50) & (below.max(axis=1) < 110)
    assert dark_grey.mean() > 0.1
    assert len(np.unique((pixels // 8).reshape(-1, 3), axis=0)) > 100
