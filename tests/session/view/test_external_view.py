import json
import threading
from pathlib import Path
from typing import Any

import msgspec
import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

from simconsole.hud.driver_view.vehicle_body import Size
from simconsole.hud.view import HudSettings
from simconsole.profiles.view import HudProfile
from simconsole.session.lifecycle import drive
from simconsole.session.resolution import load_session, resolve
from simconsole.session.view.external_view import display_settings, external_view
from simconsole.session.view.view_job import ViewJob
from tests.drives.controllers import command
from tests.hud.test_view import snapshot
from tests.paths import ROOT
from tests.patience import PATIENCE_S, wait_until
from tests.ports import free_port

SESSION = """\
schema: 1
scenario: {vehicle: hatchback, duration_s: 1}
features: {control: {person_required: false}}
outputs: {bridge: {port: 0, external_view: true}, hud: null, scene: null, report: false}
devices: {driver: none}
mode: {pacing: lockstep, tick_hz: 250, answer_timeout_s: 60}
"""


def test_the_models_are_those_of_the_frames() -> None:
    job = ViewJob(None, (), Size(3.99, 1.75, 1.45, 0.75, 2.5), 15.0)
    view = external_view(job, HudSettings(limit_kmh=30.0))
    assert [model.frame for model in view.models] == ["map", "base_link"]
    assert all(model.content.startswith(b"glTF") for model in view.models)
    frames = view.frames(snapshot(vehicle__x_m=4.0, vehicle__yaw_rad=0.5))
    assert frames[0] == ("map", "base_link", (4.0, 0.0, 0.0), (0.0, 0.0, 0.5))
    assert len(frames) == 6
    assert view.reading(snapshot(situation__lane=-1.0))["speed_limit"] == pytest.approx(30.0 / 3.6)


def test_a_session_without_a_display_has_the_rules_of_the_drive() -> None:
    session = load_session(str(ROOT / "examples" / "web_view" / "session.yaml"))
    settings = display_settings(resolve(session))
    assert session.outputs.hud is None
    assert settings.rpm_max == HudProfile().rpm_max
    assert settings.takeover_window_s == session.features.control.minimal_risk_after_s
    wider = msgspec.structs.replace(session.outputs, hud=HudProfile(rpm_max=9000.0))
    assert display_settings(resolve(msgspec.structs.replace(session, outputs=wider))).rpm_max == 9000.0


def watch_and_answer(port: int, heard: dict[str, list[Any]]) -> None:
    """Subscribe to what a view needs, and answer every odometry so that the drive goes on."""

    def connected() -> ClientConnection | None:
        try:
            return connect(f"ws://127.0.0.1:{port}", compression=None, ping_interval=None)
        except OSError:
            return None

    web = wait_until(connected, "the console")
    assert web is not None
    with web:
        for topic in (*heard, "/odom"):
            web.send(json.dumps({"op": "subscribe", "topic": topic}))
        try:
            for text in web:
                message = json.loads(text)
                if message["topic"] == "/odom":
                    web.send(json.dumps(command(message["msg"]["header"]["stamp"])))
                else:
                    heard[message["topic"]].append(message["msg"])
        except ConnectionClosed:
            return


def test_a_drive_in_lockstep_tells_it_too(tmp_path: Path) -> None:
    port, heard = free_port(), {topic: list[Any]() for topic in ("/view/scene", "/view/poses", "/view/hud")}
    (tmp_path / "session.yaml").write_text(SESSION.replace("port: 0", f"port: {port}"))
    session = load_session(str(tmp_path / "session.yaml"))
    client = threading.Thread(target=watch_and_answer, args=(port, heard))
    client.start()
    result = drive(resolve(session), tmp_path / "bundle")
    client.join(PATIENCE_S)
    assert (result.ticks, result.summary["unanswered"]) == (250, 0)
    assert [len(heard[topic]) for topic in ("/view/scene", "/view/poses", "/view/hud")] == [1, 50, 20]
    assert len(heard["/view/poses"][-1]["transforms"]) == 6
    assert [marker["header"]["frame_id"] for marker in heard["/view/scene"][0]["markers"]] == ["map", "base_link"]
