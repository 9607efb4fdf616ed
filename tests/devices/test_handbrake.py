"""A handbrake on a plug of its own: armed at rest, lost, back again; every case with virtual devices."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import msgspec
import pytest
from msgspec.structs import replace

from simconsole.devices.calibration.cockpit_check import CockpitCheck
from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.calibration.inverse_calibration import Intent, raw_sample
from simconsole.devices.setup.calibration_dialogue import calibrate_devices
from simconsole.devices.setup.device_commands import Pace, check_devices, list_devices
from simconsole.devices.sources.sdl_source import SdlSource
from simconsole.devices.sources.virtual_cockpit import VirtualCockpit
from simconsole.faults.cockpit_faults import effect
from simconsole.profiles.device import CockpitProfile, RoleBinding
from simconsole.profiles.faults import Unplug
from simconsole.profiles.files.loader import load, parse, to_text
from simconsole.profiles.parts.axes import PedalAxis
from simconsole.values.errors import DeviceNotFound, ProfileError
from simconsole.values.signals import NEVER_TICKS, DeviceSample, DriverInput
from simconsole.values.validity import LIVE, LOST, STALE, UNKNOWN
from tests.devices.calibration_run import CalibrationRun
from tests.devices.conftest import TICK_HZ

LEVER = RoleBinding(role="handbrake", vendor_id=0x10C4, product_id=0x82C0, name="USB handbrake", axes=1, buttons=0)


@pytest.fixture(scope="module")
def cockpit(t500: CockpitProfile) -> CockpitProfile:
    pedals = replace(t500.pedals, handbrake=PedalAxis(axis=0, rest_raw=-1.0, full_raw=1.0))
    return replace(t500, roles=[*t500.roles, LEVER], pedals=pedals)


class Drive:
    """Intents in, through SDL, calibrated out."""

    def __init__(self, cockpit: CockpitProfile, *, reverse_order: bool = False) -> None:
        self.plugged = VirtualCockpit(cockpit, reverse_order=reverse_order)
        self.calibration = CalibrationRun(cockpit_settings(cockpit, TICK_HZ))
        self.source: SdlSource | None = None
        self.tick = 0

    def do(self, intent: Intent, ticks: int = 1) -> DriverInput:
        self.plugged.write(raw_sample(intent, self.calibration.settings))
        return self.poll(ticks)

    def poll(self, ticks: int = 1) -> DriverInput:
        assert self.source is not None
        for _ in range(ticks):
            self.tick += 1
            driver = self.calibration.calibrate(self.source.poll(self.tick))
        return driver

    def close(self) -> None:
        if self.source is not None:
            self.source.close()
        self.plugged.close()


@pytest.fixture(params=[False, True], ids=["wheel first", "handbrake first"])
def drive(request: pytest.FixtureRequest, sdl: None, cockpit: CockpitProfile) -> Iterator[Drive]:
    ready = Drive(cockpit, reverse_order=request.param)
    ready.source = SdlSource(cockpit)
    ready.do(Intent(), ticks=2)
    yield ready
    ready.close()


def test_own_device_pulls_the_handbrake_and_nothing_else(drive: Drive) -> None:
    assert drive.source is not None
    numbers = {role: drive.source.instance_id(role) for role in ("wheel", "pedals", "shifter", "handbrake")}
    assert numbers["handbrake"] is not None
    assert len(set(numbers.values())) == 3, "wheel and pedals on one plug, shifter and handbrake on their own"
    driver = drive.do(Intent(handbrake=0.7, throttle=0.2))
    assert (driver.handbrake, driver.throttle, driver.brake) == pytest.approx((0.7, 0.2, 0.0), abs=1e-4)
    assert driver.hand_wheel_rad == pytest.approx(0.0, abs=1e-3)
    assert driver.handbrake_validity == LIVE


def test_lost_handbrake_is_released_and_said_and_the_rest_drives_on(drive: Drive) -> None:
    """SDL centres the axis first, which for this lever is half pulled."""
    assert drive.do(Intent(handbrake=1.0, throttle=0.5, gear=2)).handbrake == pytest.approx(1.0, abs=1e-4)
    drive.plugged.unplug("handbrake")
    for _ in range(50):
        driver = drive.poll()
        assert (driver.handbrake, driver.handbrake_validity) == (0.0, LOST)
        assert driver.throttle == pytest.approx(0.5, abs=1e-4)
        assert (driver.brake_validity, driver.wheel_validity, driver.shifter_validity) == (LIVE, LIVE, LIVE)


def test_handbrake_that_comes_back_pulled_must_be_let_go_first(drive: Drive) -> None:
    drive.do(Intent(handbrake=0.9))
    drive.plugged.unplug("handbrake")
    drive.poll(3)
    drive.plugged.plug("handbrake")
    drivers = [drive.do(Intent(handbrake=0.9)) for _ in range(10)]
    assert {driver.handbrake for driver in drivers} == {0.0}
    assert drivers[-1].handbrake_validity == UNKNOWN
    drive.do(Intent())
    driver = drive.do(Intent(handbrake=0.9))
    assert (driver.handbrake, driver.handbrake_validity) == (pytest.approx(0.9, abs=1e-4), LIVE)


def test_unplugged_and_back_between_two_polls_is_lost_once(drive: Drive) -> None:
    drive.do(Intent(handbrake=0.6))
    drive.plugged.unplug("handbrake")
    drive.plugged.plug("handbrake")
    assert drive.poll().handbrake_validity == LOST
    assert drive.poll(2).handbrake_validity == LIVE


def test_lost_pedals_leave_the_handbrake(drive: Drive) -> None:
    drive.do(Intent(brake=0.5, handbrake=0.5))
    drive.plugged.unplug("pedals")
    driver = drive.poll(3)
    assert (driver.brake, driver.brake_validity) == (0.0, LOST)
    assert (driver.handbrake, driver.handbrake_validity) == (pytest.approx(0.5, abs=1e-4), LIVE)


def test_pulled_at_the_start_counts_only_after_it_was_let_go(cockpit: CockpitProfile) -> None:
    calibration = CalibrationRun(cockpit_settings(cockpit, TICK_HZ))
    driver = calibration.do(Intent(handbrake=1.0), ticks=10)
    assert (driver.handbrake, driver.handbrake_validity, driver.brake_validity) == (0.0, UNKNOWN, LIVE)
    calibration.do(Intent())
    assert calibration.do(Intent(handbrake=1.0)).handbrake == 1.0


def test_silent_handbrake_is_held_for_the_limit_and_then_released(cockpit: CockpitProfile) -> None:
    calibration = CalibrationRun(cockpit_settings(cockpit, TICK_HZ))
    calibration.do(ticks=2)
    held = calibration.do(Intent(handbrake=0.8), handbrake_age_ticks=25.0)
    assert held.handbrake == pytest.approx(0.8)
    silent = calibration.do(Intent(handbrake=0.8), handbrake_age_ticks=26.0)
    assert (silent.handbrake, silent.handbrake_validity, silent.brake_validity) == (0.0, STALE, LIVE)


@pytest.mark.parametrize(("own", "gone"), [(True, [0.0, 0.0, NEVER_TICKS]), (False, [NEVER_TICKS, 0.0, NEVER_TICKS])])
def test_fault_on_the_handbrake_takes_what_hangs_on_its_plug(
    own: bool, gone: list[float], cockpit: CockpitProfile, t500: CockpitProfile
) -> None:
    seated = cockpit if own else t500
    numbers = cockpit_settings(seated, TICK_HZ)
    act = effect(Unplug(at_s=0.0, device="handbrake"), seated, numbers, TICK_HZ)
    sample = act(raw_sample(Intent(), numbers), 1, 1)
    assert [sample.pedals_age_ticks, sample.shifter_age_ticks, sample.handbrake_age_ticks] == gone


def test_missing_handbrake_is_named_at_the_start(sdl: None, cockpit: CockpitProfile, t500: CockpitProfile) -> None:
    plugged = VirtualCockpit(t500)
    with pytest.raises(DeviceNotFound, match=r"role handbrake: value 10c4:82c0 \(USB handbrake\) not connected"):
        SdlSource(cockpit)
    plugged.close()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda plain: plain["pedals"].update(handbrake=None), "pedals.handbrake must name the axis"),
        (lambda plain: plain["pedals"]["handbrake"].update(axis=1), "pedals.handbrake.axis 1 must be below 1"),
        (lambda plain: plain["roles"].append(plain["roles"][-1]), "once each"),
    ],
)
def test_profile_that_cannot_be_meant_is_refused(
    change: Callable[[Any], None], message: str, cockpit: CockpitProfile
) -> None:
    plain = msgspec.to_builtins(cockpit)
    change(plain)
    with pytest.raises(ProfileError, match=message):
        parse(to_text(plain), CockpitProfile, "cockpit.yaml")


def at_once(tick_hz: int) -> Pace:
    return lambda tick: None


def test_calibration_learns_a_handbrake_of_its_own_and_check_tries_it(
    sdl: None, cockpit: CockpitProfile, t500: CockpitProfile, tmp_path: Path
) -> None:
    path, said = tmp_path / "mine.yaml", list[str]()

    def ask(text: str) -> str:
        return "s" if "HANDBRAKE BUTTON" in text else ""

    calibrate_devices(t500, path, say=said.append, ask=ask, virtual=cockpit, pace=at_once)
    learnt = load("devices", str(path), CockpitProfile)
    assert not [line for line in said if "again" in line]
    assert [(role.role, role.product_id) for role in learnt.roles][2:] == [("shifter", 0xB660), ("handbrake", 0x82C0)]
    assert learnt.pedals.handbrake is not None
    assert (learnt.pedals.handbrake.axis, learnt.pedals.handbrake.rest_raw) == (0, -1.0)
    assert learnt.pedals.handbrake.full_raw == pytest.approx(0.98, abs=1e-3)
    found = list_devices(learnt, say=said.append, virtual=True)
    assert found["missing_roles"] == []
    assert said[-1] == "10c4:82c0  USB handbrake: 1 axes, 0 buttons, 0 hats: handbrake"
    checked = check_devices(learnt, say=said.append, duration_s=15.0, virtual=True, pace=at_once(TICK_HZ))
    assert checked["problems"] == []
    assert checked["pedals"]["handbrake"]["most"] > 0.95


def test_check_tells_a_lost_handbrake_from_a_pulled_one(cockpit: CockpitProfile) -> None:
    def problems(*samples: DeviceSample) -> list[str]:
        check = CockpitCheck(cockpit, TICK_HZ)
        for sample in samples:
            check.add(sample)
        return check.problems()

    numbers = cockpit_settings(cockpit, TICK_HZ)
    rest = raw_sample(Intent(), numbers)
    assert problems(rest) == []
    lost = problems(rest, rest._replace(handbrake_age_ticks=NEVER_TICKS))
    assert lost == ["pedals.handbrake: value no reading: a device that answers"]
    (pulled,) = problems(raw_sample(Intent(handbrake=1.0), numbers))
    assert pulled.startswith("pedals.handbrake: value 100% pressed at least: at most 5% at rest")
