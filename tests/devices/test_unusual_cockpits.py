"""Cockpits beyond the shipped ones: more than 24 buttons, throttle and brake on one axis, two devices of one kind.

Each as virtual joysticks in SDL, from the raw device to what the person does.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import msgspec
import pytest

from simconsole.devices.calibration.cockpit_settings import NOBODY, button_bits, cockpit_settings
from simconsole.devices.calibration.inverse_calibration import Intent, raw_sample
from simconsole.devices.setup.calibration_dialogue import calibrate_devices
from simconsole.devices.setup.device_commands import check_devices, list_devices
from simconsole.devices.sources.sdl_source import SdlSource
from simconsole.devices.sources.virtual_cockpit import VirtualCockpit
from simconsole.devices.sources.virtual_joystick import VirtualDevice, VirtualSpec
from simconsole.profiles.device import Buttons, CockpitProfile
from simconsole.profiles.files.loader import load, parse, to_text
from simconsole.values.errors import DeviceError, DeviceNotFound, ProfileError
from simconsole.values.signals import NEVER_TICKS, Button, DriverInput
from tests.devices.calibration_run import CalibrationRun

Plug = Callable[[VirtualSpec], VirtualDevice]
TICK_HZ = 250
BOARD = {"vendor_id": 0x1DD2, "product_id": 0x000C, "name": "a board for levers", "axes": 3, "buttons": 0}
"""The board of many home-made pedals and handbrakes: each of them answers with the same id."""


def with_changes(profile: CockpitProfile, change: Callable[[dict[str, Any]], object]) -> CockpitProfile:
    plain = msgspec.to_builtins(profile)
    change(plain)
    return parse(to_text(plain), CockpitProfile, "cockpit.yaml")


@pytest.fixture
def many_buttons(t500: CockpitProfile) -> CockpitProfile:
    """A rim of 60 buttons, some of which mean something, and a shifter with its gears on 32 to 39."""

    def change(plain: dict[str, Any]) -> None:
        plain["roles"][0]["buttons"] = plain["roles"][1]["buttons"] = 60
        plain["roles"][2] |= {"buttons": 40, "others": []}
        plain["shifter"] |= {"gears": list(range(32, 39)), "reverse": 39}
        for button, number in (("emergency_stop", 59), ("autonomous", 24), ("manual", 31)):
            plain["buttons"][button] = {"button": number}

    return with_changes(t500, change)


@pytest.fixture
def combined(t500: CockpitProfile) -> CockpitProfile:
    """Throttle to one side of an axis, brake to its other."""

    def change(plain: dict[str, Any]) -> None:
        plain["pedals"]["throttle"] |= {"axis": 2, "rest_raw": 0.0, "full_raw": -1.0}
        plain["pedals"]["brake"] |= {"axis": 2, "rest_raw": 0.0, "full_raw": 1.0}

    return with_changes(t500, change)


@pytest.fixture
def two_boards(t500: CockpitProfile) -> CockpitProfile:
    """Pedals and handbrake, each on a board of the same kind."""

    def change(plain: dict[str, Any]) -> None:
        plain["roles"][1] = {"role": "pedals", **BOARD, "port": "usb-1"}
        plain["roles"].append({"role": "handbrake", **BOARD, "port": "usb-2"})
        for axis, name in enumerate(("throttle", "brake", "clutch")):
            plain["pedals"][name] |= {"axis": axis, "rest_raw": -1.0, "full_raw": 1.0}
        plain["pedals"]["handbrake"] = {"axis": 0, "rest_raw": -1.0, "full_raw": 1.0}

    return with_changes(t500, change)


class Cockpit:
    """An intent in, through SDL, what the person does out."""

    def __init__(self, profile: CockpitProfile, plugged: VirtualCockpit, source: SdlSource) -> None:
        self.plugged, self.source = plugged, source
        self.calibration = CalibrationRun(cockpit_settings(profile, TICK_HZ))
        self.tick = 0

    def do(self, intent: Intent = Intent(), ticks: int = 30) -> DriverInput:  # noqa: B008  # immutable
        self.plugged.write(raw_sample(intent, self.calibration.settings))
        driver = NOBODY
        for _ in range(ticks):
            self.tick += 1
            driver = self.calibration.calibrate(self.source.poll(self.tick))
        return driver


@contextmanager
def opened(profile: CockpitProfile, *, reverse_order: bool = False) -> Iterator[Cockpit]:
    plugged = VirtualCockpit(profile, reverse_order=reverse_order)
    try:
        source = SdlSource(profile)
        try:
            cockpit = Cockpit(profile, plugged, source)
            cockpit.do()
            yield cockpit
        finally:
            source.close()
    finally:
        plugged.close()


def test_every_button_of_a_rim_with_60_reaches_the_person(sdl: None, many_buttons: CockpitProfile) -> None:
    with opened(many_buttons) as cockpit:
        for button in Button:
            if getattr(many_buttons.buttons, str(button.name).lower()) is not None:
                assert int(cockpit.do(Intent(pressed=int(button))).pressed) == button
                assert cockpit.do().pressed == 0.0
        for gear in (*range(1, 8), -1):
            assert cockpit.do(Intent(gear=float(gear))).gear == gear


def test_a_short_press_of_button_59_is_not_lost(sdl: None, many_buttons: CockpitProfile) -> None:
    with opened(many_buttons) as cockpit:
        wheel = cockpit.plugged._devices[many_buttons.roles[0].key]
        wheel.set_button(59, True)
        wheel._sdl.SDL_JoystickUpdate()
        wheel.set_button(59, False)
        held = int(cockpit.source.poll(99).wheel_buttons)
        assert held == 1 << button_bits(many_buttons, "wheel")[59]
        assert cockpit.source.poll(100).wheel_buttons == 0.0


def test_buttons_without_a_meaning_press_nothing(sdl: None, many_buttons: CockpitProfile) -> None:
    named = {59, 24, 31, 0, 1, 2, 3, 6, 7, 8, 10, 11, 12}
    with opened(many_buttons) as cockpit:
        wheel = cockpit.plugged._devices[many_buttons.roles[0].key]
        for number in set(range(60)) - named:
            wheel.set_button(number, True)
        assert cockpit.do().pressed == 0.0


def test_combined_pedals_press_one_at_a_time(sdl: None, combined: CockpitProfile) -> None:
    with opened(combined) as cockpit:
        driver = cockpit.do(Intent(throttle=0.7))
        assert (driver.throttle, driver.brake) == (pytest.approx(0.7, abs=1e-3), 0.0)
        driver = cockpit.do(Intent(brake=0.4))
        assert (driver.throttle, driver.brake) == (0.0, pytest.approx(0.4, abs=1e-3))
        driver = cockpit.do(Intent(throttle=1.0, brake=1.0))
        assert (driver.throttle, driver.brake) == (0.0, 0.0), "they cancel on the one axis"


def test_combined_pedals_unplugged_press_neither(sdl: None, combined: CockpitProfile) -> None:
    with opened(combined) as cockpit:
        cockpit.do(Intent(throttle=1.0))
        cockpit.plugged.unplug("pedals")
        driver = cockpit.do()
        assert (driver.throttle, driver.brake) == (0.0, 0.0)


def test_check_of_combined_pedals_is_content(sdl: None, combined: CockpitProfile) -> None:
    results = check_devices(combined, say=lambda line: None, duration_s=7.0, virtual=True, pace=lambda tick: None)
    assert results["ok"], results["problems"]
    for name in ("throttle", "brake"):
        assert results["pedals"][name] == {"least": 0.0, "most": pytest.approx(1.0, abs=0.03)}


@pytest.mark.parametrize("kind", ["many_buttons", "combined", "two_boards"])
def test_calibration_finds_them_again(
    kind: str, sdl: None, t500: CockpitProfile, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    cockpit: CockpitProfile = request.getfixturevalue(kind)
    path = tmp_path / "learnt.yaml"
    skipped = [name for name in Buttons.__struct_fields__ if getattr(cockpit.buttons, name) is None]
    texts = [f"for {name.replace('_', ' ').upper()}" for name in skipped]
    texts += ["the HANDBRAKE"] if cockpit.pedals.handbrake is None else []

    def ask(text: str) -> str:
        return "s" if any(word in text for word in texts) else ""

    def say(line: str) -> None:
        assert "again, please" not in line

    calibrate_devices(t500, path, say=say, ask=ask, virtual=cockpit, pace=lambda rate: lambda tick: None)
    learnt = load("devices", str(path), CockpitProfile)
    assert {role.role: role.key for role in learnt.roles} == {role.role: role.key for role in cockpit.roles}
    assert learnt.buttons == cockpit.buttons
    assert learnt.shifter.gears == cockpit.shifter.gears
    assert learnt.pedals.combined is cockpit.pedals.combined
    for name in ("throttle", "brake", "clutch", "handbrake"):
        meant, found = getattr(cockpit.pedals, name), getattr(learnt.pedals, name)
        assert (meant is None) is (found is None)
        if meant is not None:
            assert found.axis == meant.axis
            assert found.rest_raw == pytest.approx(meant.rest_raw, abs=1e-3)
            assert found.full_raw == pytest.approx(meant.full_raw, abs=0.03)


@pytest.mark.parametrize("reverse_order", [False, True])
def test_two_boards_of_one_kind_are_told_apart_in_any_order(
    reverse_order: bool, sdl: None, two_boards: CockpitProfile
) -> None:
    with opened(two_boards, reverse_order=reverse_order) as cockpit:
        driver = cockpit.do(Intent(throttle=0.8))
        assert (driver.throttle, driver.handbrake) == (pytest.approx(0.8, abs=1e-3), 0.0)
        driver = cockpit.do(Intent(handbrake=0.6))
        assert (driver.throttle, driver.handbrake) == (0.0, pytest.approx(0.6, abs=1e-3))
        assert [device.port for device in cockpit.source.identities() if device.port] == ["usb-1", "usb-2"]


def test_the_other_board_never_takes_the_place_of_an_unplugged_one(sdl: None, two_boards: CockpitProfile) -> None:
    with opened(two_boards) as cockpit:
        cockpit.plugged.unplug("pedals")
        cockpit.do(Intent(handbrake=1.0))
        sample = cockpit.source.poll(99)
        assert (sample.pedals_age_ticks, sample.handbrake_age_ticks) == (NEVER_TICKS, 0.0)
        cockpit.plugged.plug("pedals")
        driver = cockpit.do(Intent(handbrake=1.0))
        assert (driver.throttle, driver.brake, driver.handbrake) == (0.0, 0.0, pytest.approx(1.0, abs=1e-3))


def test_two_wheels_of_one_kind_are_refused_until_the_profile_says_which(
    sdl: None, plug: Plug, t500: CockpitProfile
) -> None:
    plugged = VirtualCockpit(t500)
    try:
        plug(plugged.spec("wheel")._replace(port="usb-9"))
        with pytest.raises(DeviceError, match=r"role wheel: value two devices 044f:b65e: one, or its port .*'usb-9'"):
            SdlSource(t500)
    finally:
        plugged.close()


def test_a_device_at_another_port_is_named(sdl: None, plug: Plug, two_boards: CockpitProfile) -> None:
    plugged = VirtualCockpit(two_boards)
    try:
        plugged.unplug("handbrake")
        plug(plugged.spec("handbrake")._replace(port="usb-7"))
        with pytest.raises(DeviceNotFound, match=r"role handbrake: .* at usb-2 not connected: .* at usb-7"):
            SdlSource(two_boards)
    finally:
        plugged.close()


def test_list_says_the_port_and_the_role_of_each(sdl: None, two_boards: CockpitProfile) -> None:
    said: list[str] = []
    found = list_devices(two_boards, say=said.append, virtual=True)
    assert {entry["port"]: entry["roles"] for entry in found["devices"] if entry["port"]} == {
        "usb-1": ["pedals"],
        "usb-2": ["handbrake"],
    }
    assert any("at usb-2" in line and "handbrake" in line for line in said)


@pytest.mark.parametrize(
    ("change", "complaint"),
    [
        (
            lambda plain: plain["pedals"]["brake"].update(full_raw=-0.9),
            "throttle and brake share axis 2: rest_raw must",
        ),
        (lambda plain: plain["pedals"]["brake"].update(rest_raw=0.5), "throttle and brake share axis 2: rest_raw must"),
        (lambda plain: plain["roles"][1].update(port="usb-1"), "roles.port must be given for all devices 044f:b65e"),
        (lambda plain: plain["buttons"].update(mark={"button": 128}), "0 to 127"),
    ],
)
def test_profiles_that_cannot_be_meant_are_refused(
    change: Callable[[dict[str, Any]], object], complaint: str, combined: CockpitProfile
) -> None:
    with pytest.raises(ProfileError, match=complaint):
        with_changes(combined, change)
