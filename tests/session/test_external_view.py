import msgspec
import pytest

from simconsole.hud.driver_view.vehicle_body import Size
from simconsole.hud.view import HudSettings
from simconsole.profiles.view import HudProfile
from simconsole.session.external_view import display_settings, external_view
from simconsole.session.resolution import load_session, resolve
from simconsole.session.view_job import ViewJob
from tests.hud.test_view import snapshot
from tests.paths import ROOT


def test_the_models_are_those_of_the_frames() -> None:
    job = ViewJob(None, 30.0, Size(3.99, 1.75, 1.45, 0.75, 2.5), 15.0)
    view = external_view(job, HudSettings())
    assert [model.frame for model in view.models] == ["map", "base_link"]
    assert all(model.content.startswith(b"glTF") for model in view.models)
    frames = view.frames(snapshot(vehicle__x_m=4.0, vehicle__yaw_rad=0.5))
    assert frames[0] == ("map", "base_link", (4.0, 0.0, 0.0), (0.0, 0.0, 0.5))
    assert len(frames) == 6
    assert view.reading(snapshot())["speed_limit"] == pytest.approx(30.0 / 3.6)


def test_a_session_without_a_display_has_the_rules_of_the_drive() -> None:
    session = load_session(str(ROOT / "examples" / "web_view" / "session.yaml"))
    settings = display_settings(resolve(session))
    assert session.outputs.hud is None
    assert settings.rpm_max == HudProfile().rpm_max
    assert settings.takeover_window_s == session.features.control.minimal_risk_after_s
    wider = msgspec.structs.replace(session.outputs, hud=HudProfile(rpm_max=9000.0))
    assert display_settings(resolve(msgspec.structs.replace(session, outputs=wider))).rpm_max == 9000.0
