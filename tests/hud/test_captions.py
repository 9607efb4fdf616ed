from typing import Any

import pytest

from simconsole.hud.banner import ALERT_LABELS, Alert
from simconsole.hud.captions import LONGEST_BUTTON, MENDING, STEER_OR_BRAKE, next_step, other_side
from simconsole.hud.layout import layout
from simconsole.hud.view import HudMemory, HudSettings, HudView, view
from simconsole.profiles.view import ENGLISH
from simconsole.values.labels import reason_label
from simconsole.values.signals import NEVER_TICKS, Commander, Mode, Reason, Validity
from simconsole.values.state_vector import Snapshot
from tests.hud.pictures import SCREEN, by_role, in_mode, said
from tests.hud.test_view import snapshot

LIVE: dict[str, Any] = {f"driver__{axis}_validity": float(Validity.LIVE) for axis in ("wheel", "throttle", "brake")}
SETTINGS = HudSettings(manual_button="cross", reset_button="R2")


def step(row: Snapshot) -> str:
    return next_step(row, ENGLISH, 0.1, "cross", "R2")


def shown(row: Snapshot, memory: HudMemory | None = None) -> HudView:
    return view(row, 0.0, memory or HudMemory(), SETTINGS)[0]


@pytest.mark.parametrize(
    ("mode", "remote", "more", "who"),
    [
        (Mode.PARKED, 1.0, {}, "NOBODY"),
        (Mode.MANUAL, 0.0, {}, ""),
        (Mode.MANUAL, 0.5, {}, "CONSOLE"),
        (Mode.MANUAL, 0.5, {"arbitration__commander": float(Commander.ROS)}, "AUTOPILOT"),
        (Mode.SHARED, 0.5, {}, "AUTOPILOT"),
        (Mode.AUTONOMOUS, 1.0, {}, "AUTOPILOT"),
        (Mode.TAKEOVER_REQUESTED, 1.0, {}, "AUTOPILOT"),
        (Mode.MINIMAL_RISK, 1.0, {}, "CONSOLE"),
        (Mode.MINIMAL_RISK, 1.0, {"memory__stop_steered": 1.0}, "AUTOPILOT"),
        (Mode.STOPPED, 1.0, {}, "NOBODY"),
        (Mode.EMERGENCY_STOP, 1.0, {}, "CONSOLE"),
    ],
)
def test_the_share_bar_names_who_drives(mode: Mode, remote: float, more: dict[str, Any], who: str) -> None:
    row = snapshot(arbitration__mode=mode, arbitration__remote_lateral=remote, **more)
    assert other_side(row) == who
    assert said(shown(row), "share.label") == ["YOU", *([who] if who else [])]
    share = [] if not who else ["--"] if who == "NOBODY" else [f"{100.0 * remote:.0f} %"]
    assert said(shown(row), "share.other") == share
    drawn = bool(by_role(layout(shown(row), SCREEN), "share.remote"))
    assert drawn == (who not in ("", "NOBODY"))


@pytest.mark.parametrize("mode", [Mode.TAKEOVER_REQUESTED, Mode.MINIMAL_RISK, Mode.STOPPED])
@pytest.mark.parametrize(
    ("lost", "heard", "words"),
    [
        ("wheel", False, "plug the wheel in"),
        ("wheel", True, "align wheel with car"),
        ("throttle", False, "plug the pedals in"),
        ("brake", True, "release the pedals"),
    ],
)
def test_nobody_is_told_to_steer_or_brake_with_a_lost_cockpit(mode: Mode, lost: str, heard: bool, words: str) -> None:
    gone: dict[str, Any] = {f"driver__{lost}_validity": float(Validity.LOST)}
    device = "wheel" if lost == "wheel" else "pedals"
    age: dict[str, Any] = {f"sample__{device}_age_ticks": 1.0 if heard else NEVER_TICKS}
    assert step(snapshot(arbitration__mode=mode, **{**LIVE, **gone, **age})) == words


@pytest.mark.parametrize(
    ("mode", "speed_mps", "words"),
    [
        (Mode.PARKED, 0.0, ""),
        (Mode.MANUAL, 20.0, ""),
        (Mode.AUTONOMOUS, 20.0, ""),
        (Mode.TAKEOVER_REQUESTED, 20.0, STEER_OR_BRAKE),
        (Mode.MINIMAL_RISK, 20.0, STEER_OR_BRAKE),
        (Mode.STOPPED, 0.0, "press cross to drive"),
        (Mode.EMERGENCY_STOP, 20.0, "wait: car is braking"),
        (Mode.EMERGENCY_STOP, -20.0, "wait: car is braking"),
        (Mode.EMERGENCY_STOP, 0.0, "press R2 to reset"),
    ],
)
def test_the_next_step_is_told_with_the_buttons_name(mode: Mode, speed_mps: float, words: str) -> None:
    assert step(snapshot(arbitration__mode=mode, vehicle__vx_mps=speed_mps, **LIVE)) == words


def test_a_step_without_a_button_is_the_operators() -> None:
    for mode in (Mode.STOPPED, Mode.EMERGENCY_STOP):
        assert next_step(snapshot(arbitration__mode=mode, **LIVE), ENGLISH, 0.1, "", "") == "ask the operator"
    assert next_step(snapshot(arbitration__mode=Mode.STOPPED, **LIVE), ENGLISH, 0.1, "", "R2") == "press R2 to drive"


def test_a_stopped_car_tells_why_it_has_stopped() -> None:
    going = snapshot(arbitration__mode=Mode.MINIMAL_RISK, arbitration__reason=Reason.COMMAND_STALE, **LIVE)
    stands = snapshot(arbitration__mode=Mode.STOPPED, arbitration__reason=Reason.STANDSTILL, **LIVE)
    parked = snapshot(arbitration__mode=Mode.PARKED, arbitration__reason=Reason.RESET, **LIVE)
    memory = HudMemory()
    causes = []
    for row in (going, stands, stands, parked, stands):
        content, memory = view(row, 0.0, memory, SETTINGS)
        causes.append(content.reason_label)
    assert causes == [*["autopilot went silent"] * 3, "reset", "standing still"]
    assert said(shown(stands), "alert.label") == ["STOPPED"]
    assert said(shown(stands), "alert.todo") == ["press cross to drive"]


def test_what_is_refused_in_a_latched_stop_is_told() -> None:
    for mode in (Mode.STOPPED, Mode.EMERGENCY_STOP):
        told = in_mode(mode, todo_label="press R2 to reset", refusal_label="refused: car is moving")
        assert said(told, "alert.todo") == ["refused: car is moving"]


def test_all_that_an_alert_can_say_is_at_most_seven_words() -> None:
    steps = {
        Alert.STOPPED: (*MENDING, "press paddle left to drive", *map(reason_label, Reason)),
        Alert.TAKE_OVER: (*MENDING, STEER_OR_BRAKE),
        Alert.MINIMAL_RISK: (*MENDING, STEER_OR_BRAKE),
        Alert.TAKE_OVER_NOW: (*MENDING, STEER_OR_BRAKE),
        Alert.EMERGENCY: ("wait: car is braking", "press paddle left to reset"),
    }
    for alert, todos in steps.items():
        for todo in todos:
            assert len(f"{ALERT_LABELS[alert][0]} {todo}".split()) <= 7, (alert, todo)
    assert len(LONGEST_BUTTON) == 16


@pytest.mark.parametrize("gear", ["N", "R", "6"])
def test_nobody_is_told_to_shift_up_where_there_is_no_higher_gear(gear: str) -> None:
    screaming = HudView(settings=HudSettings(top_gear=6), rpm=7000.0, gear=gear)
    assert said(screaming, "shift") == []
    assert said(screaming._replace(gear="5"), "shift") == ["UP"]


def test_the_hands_are_marked_where_they_hold_the_wheel() -> None:
    row = snapshot(vehicle__road_wheel_rad=0.1, driver__hand_wheel_rad=-1.0, **LIVE)
    content = shown(row)
    assert (content.hand_wheel_deg, content.driver_hand_wheel_deg) == pytest.approx((85.94, -57.30), abs=0.01)
    assert by_role(layout(content, SCREEN), "steering.hands")
    lost = shown(snapshot(driver__hand_wheel_rad=-1.0, driver__wheel_validity=float(Validity.LOST)))
    assert lost.driver_hand_wheel_deg is None
    assert not by_role(layout(lost, SCREEN), "steering.hands")
