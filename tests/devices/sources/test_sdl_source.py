"""The cockpit through pygame's joysticks: identity, unplugging, boot mode. Every case with virtual devices."""

import random
from collections.abc import Callable
from typing import Any

import pytest
from msgspec.structs import replace

from simconsole.devices.calibration.calibrator import travel
from simconsole.devices.calibration.cockpit_settings import CockpitSettings, cockpit_settings
from simconsole.devices.calibration.inverse_calibration import Intent, raw_sample
from simconsole.devices.sources import sdl_runtime
from simconsole.devices.sources import sdl_source as sdl_module
from simconsole.devices.sources.sdl_source import SdlSource, identity
from simconsole.devices.sources.virtual_cockpit import VirtualCockpit
from simconsole.devices.sources.virtual_joystick import VirtualDevice, VirtualSpec, specs
from simconsole.profiles.device import CockpitProfile, DeviceKey
from simconsole.profiles.files.loader import load
from simconsole.values.errors import DeviceError, DeviceModeError, DeviceNotFound
from simconsole.values.signals import NEVER_TICKS, Button, DriverInput
from simconsole.values.validity import LIVE, LOST, UNKNOWN
from tests.devices.calibration_run import CalibrationRun

Plug = Callable[[VirtualSpec], VirtualDevice]


def bound_buttons(cockpit: CockpitProfile) -> list[Button]:
    """The roles that have a button."""
    return [button for button in Button if getattr(cockpit.buttons, str(button.name).lower()) is not None]


class Drive:
    """Intents in, through SDL, calibrated out."""

    def __init__(self, plugged: VirtualCockpit, source: SdlSource, settings: CockpitSettings) -> None:
        self.plugged = plugged
        self.source = source
        self.calibration = CalibrationRun(settings)
        self.tick = 0

    def do(self, intent: Intent = Intent(), ticks: int = 1) -> DriverInput:  # noqa: B008  # immutable
        self.plugged.write(raw_sample(intent, self.calibration.settings))
        return self.poll(ticks)

    def poll(self, ticks: int = 1) -> DriverInput:
        for _ in range(ticks):
            self.tick += 1
            driver = self.calibration.calibrate(self.source.poll(self.tick))
        return driver


@pytest.fixture
def drive(plugged: VirtualCockpit, source: SdlSource, t500_settings: CockpitSettings) -> Drive:
    ready = Drive(plugged, source, t500_settings)
    ready.do(ticks=2)
    return ready


def test_guid_tells_the_usb_identity() -> None:
    assert identity("0300b6364f0400005eb6000011010000") == (0x044F, 0xB65E)


def test_each_device_is_named_once_with_all_that_it_plays(
    source: SdlSource, plugged: VirtualCockpit, t500: CockpitProfile
) -> None:
    found = source.identities()
    roles = [role for device in found for role in device.roles]
    assert len(roles) == len(set(roles))
    assert set(roles) == {"wheel", "pedals", "shifter"}
    for device in found:
        binding = next(binding for binding in t500.roles if binding.role in device.roles)
        assert device.usb_id == f"{binding.vendor_id:04x}:{binding.product_id:04x}"
        assert device.name
    plugged.unplug("shifter")
    source.poll(1)
    assert "shifter" not in [role for device in source.identities() for role in device.roles]


def test_first_sample_shows_pedals_at_rest(source: SdlSource) -> None:
    sample = source.poll(1)
    assert (sample.throttle_axis, sample.brake_axis, sample.clutch_axis) == pytest.approx((1.0,) * 3, abs=1e-4)
    assert (sample.wheel_age_ticks, sample.pedals_age_ticks, sample.shifter_age_ticks) == (0.0, 0.0, 0.0)


def test_every_role_reaches_the_person_in_any_enumeration_order(drive: Drive) -> None:
    driver = drive.do(Intent(hand_wheel_rad=1.5, throttle=0.2, brake=0.4, clutch=0.6, gear=5))
    assert driver.hand_wheel_rad == pytest.approx(1.5, abs=5e-4)
    assert (driver.throttle, driver.brake, driver.clutch) == pytest.approx((0.2, 0.4, 0.6), abs=1e-4)
    assert driver.gear == 5.0
    assert drive.do(Intent(gear=-1)).gear == -1.0


def test_roles_are_the_same_in_a_thousand_shuffled_enumerations(
    sdl: None, t500: CockpitProfile, plug: Plug, monkeypatch: pytest.MonkeyPatch, record_property: Callable[..., None]
) -> None:
    """Among other joysticks, some of which look like a wheel or a shifter; in any order of enumeration."""
    seed = 20261121
    print("seed", seed)
    dice, real = random.Random(seed), sdl_module.connected_joysticks
    others = [
        spec for name in ("g29", "t300rs_th8a", "gamepad") for spec in specs(load("devices", name, CockpitProfile))
    ]
    for spec in others:
        plug(spec)
    cockpit = VirtualCockpit(t500)

    def shuffled(pygame: Any) -> list[Any]:
        joysticks = real(pygame)
        dice.shuffle(joysticks)
        return joysticks

    monkeypatch.setattr(sdl_module, "connected_joysticks", shuffled)
    bound, orders = set(), set()
    for _ in range(1000):
        orders.add(tuple(entry.instance_id for entry, _ in shuffled(sdl_runtime.acquire())))
        sdl_runtime.release()
        source = SdlSource(t500)
        bound.add(tuple(source.instance_id(role) for role in ("wheel", "pedals", "shifter")))
        source.close()
    names: dict[int | None, int] = {entry.instance_id: entry.product_id for entry, _ in real(sdl_runtime.acquire())}
    sdl_runtime.release()
    cockpit.close()
    assert len(orders) > 500
    ((wheel, pedals, shifter),) = bound
    assert (names[wheel], names[pedals], names[shifter]) == (0xB65E, 0xB65E, 0xB660)
    record_property("enumeration", f"{len(orders)} orders of {len(names)} joysticks in 1,000 trials, the same roles")


@pytest.mark.parametrize("name", ["t300rs_th8a", "g29", "gamepad"])
def test_every_shipped_cockpit_works_as_virtual_devices(name: str, sdl: None) -> None:
    cockpit = load("devices", name, CockpitProfile)
    plugged = VirtualCockpit(cockpit)
    opened = SdlSource(cockpit)
    try:
        drive = Drive(plugged, opened, cockpit_settings(cockpit, 250))
        drive.do(ticks=2)
        driver = drive.do(Intent(hand_wheel_rad=1.5, throttle=0.2, brake=0.4, clutch=0.6), ticks=2)
        assert driver.hand_wheel_rad == pytest.approx(1.5, abs=1e-3)
        assert (driver.throttle, driver.brake, driver.clutch) == pytest.approx((0.2, 0.4, 0.6), abs=1e-3)
        if cockpit.shifter.pattern == "h":
            assert [drive.do(Intent(gear=gear)).gear for gear in (1, 6, -1)] == [1.0, 6.0, -1.0]
        else:
            assert [drive.do(Intent(pressed=held)).gear for held in (16, 0, 16)] == [1, 1, 2]
        for button in bound_buttons(cockpit):
            drive.do()
            assert drive.do(Intent(pressed=int(button))).edges == float(button)
    finally:
        opened.close()
        plugged.close()


@pytest.mark.parametrize("button", bound_buttons(load("devices", "t500rs_th8rs", CockpitProfile)))
def test_every_button_reaches_the_person(button: Button, drive: Drive) -> None:
    assert drive.do(Intent(pressed=int(button))).edges == float(button)
    assert drive.do().pressed == 0.0


def test_shuffled_enumeration_gives_the_same_roles_in_1000_trials(sdl: None, t500: CockpitProfile) -> None:
    """Wheel, pedals and shifter on three plugs, among two devices that are none of them, in any order."""
    dice = random.Random(20261121)
    print("seed 20261121")
    pedals = replace(t500.roles[1], vendor_id=0x044F, product_id=0xB371, name="Pedals", axes=4, buttons=0, hats=0)
    cockpit = replace(t500, roles=[t500.roles[0], pedals, t500.roles[2]])
    plugs = [
        VirtualSpec("Wheel", 0x044F, 0xB65E, 4, 13, 1, (0.25, 0.9, 0.9, 0.9)),
        VirtualSpec("Pedals", 0x044F, 0xB371, 4, 0, 0, (0.1, 0.5, 0.75, 0.125)),
        VirtualSpec("Shifter", 0x044F, 0xB660, 2, 10, 0, (-0.7, -0.7)),
        VirtualSpec("Pad", 0x045E, 0x028E, 6, 11, 1, (-1.0,) * 6),
        VirtualSpec("Throttle quadrant", 0x068E, 0x00FA, 8, 24, 0, (-1.0,) * 8),
    ]
    orders = set()
    sdl_runtime.acquire()
    try:
        for _ in range(1000):
            dice.shuffle(plugs)
            orders.add(tuple(spec.name for spec in plugs))
            devices = {spec.name: VirtualDevice(spec) for spec in plugs}
            devices["Shifter"].set_button(3, True)
            source = SdlSource(cockpit)
            sample = source.poll(1)
            source.close()
            for device in devices.values():
                device.close()
            axes = (sample.wheel_axis, sample.throttle_axis, sample.brake_axis, sample.clutch_axis)
            assert axes == pytest.approx((0.25, 0.75, 0.5, 0.125), abs=1e-4), orders
            assert (sample.wheel_buttons, sample.shifter_buttons) == (0.0, 8.0)
    finally:
        sdl_runtime.release()
    assert len(orders) == 120, "every order there is"


def test_axes_of_the_shifter_steer_nothing(plug: Plug, t500: CockpitProfile, drive: Drive) -> None:
    shifter = drive.plugged._devices[DeviceKey(0x044F, 0xB660)]
    shifter.set_axis(0, -1.0)
    shifter.set_axis(1, 1.0)
    assert drive.poll().hand_wheel_rad == pytest.approx(0.0)


def test_hat_is_read(drive: Drive) -> None:
    drive.plugged._devices[DeviceKey(0x044F, 0xB65E)].set_hat(0, 1, -1)
    sample = drive.source.poll(9)
    assert (sample.hat_x, sample.hat_y) == (1.0, -1.0)


@pytest.mark.fault("D01")
def test_unplugging_at_full_throttle_never_gives_half_throttle(drive: Drive) -> None:
    """D01: SDL centres all axes first and then tells; half of a pedal's travel must never come through."""
    before = drive.do(Intent(hand_wheel_rad=-0.8, throttle=1.0, gear=3), ticks=5)
    assert before.throttle == 1.0
    drive.plugged.unplug("wheel")
    for _ in range(50):
        driver = drive.poll()
        assert driver.throttle == driver.brake == driver.clutch == 0.0
        assert (driver.throttle_validity, driver.wheel_validity) == (LOST, LOST)
        assert driver.hand_wheel_rad == before.hand_wheel_rad
        assert (driver.gear, driver.shifter_validity) == (3.0, LIVE)
    sample = drive.source.poll(99)
    assert (sample.wheel_age_ticks, sample.pedals_age_ticks, sample.shifter_age_ticks) == (NEVER_TICKS, NEVER_TICKS, 0)
    assert sample.throttle_axis == pytest.approx(-1.0)


def test_unplugging_the_shifter_leaves_wheel_and_pedals(drive: Drive) -> None:
    drive.do(Intent(throttle=0.5, gear=2))
    drive.plugged.unplug("shifter")
    driver = drive.do(Intent(throttle=0.7, gear=4))
    assert driver.throttle == pytest.approx(0.7, abs=1e-4)
    assert (driver.gear, driver.shifter_validity) == (2.0, LOST)


@pytest.mark.fault("D04")
def test_device_that_comes_back_pressed_must_be_released_first(drive: Drive) -> None:
    """D04: same device by identity, nothing commanded before the pedals were seen at rest."""
    drive.do(Intent(throttle=0.9))
    drive.plugged.unplug("pedals")
    drive.poll(3)
    drive.plugged.plug("pedals")
    drive.plugged.write(raw_sample(Intent(throttle=0.9, brake=0.5), drive.calibration.settings))
    drivers = [drive.poll() for _ in range(10)]
    assert {driver.throttle for driver in drivers} == {0.0}
    assert (drivers[-1].throttle_validity, drivers[-1].wheel_validity) == (UNKNOWN, LIVE)
    drive.do()
    assert drive.do(Intent(throttle=0.9)).throttle == pytest.approx(0.9, abs=1e-4)


def test_unplugged_and_back_between_two_polls_is_lost_once(drive: Drive) -> None:
    drive.do(Intent(brake=0.6))
    drive.plugged.unplug("wheel")
    drive.plugged.plug("wheel")
    assert drive.poll().brake_validity == LOST
    assert drive.poll(2).brake_validity == LIVE


def test_unplugging_is_seen_when_someone_else_emptied_the_queue(drive: Drive) -> None:
    drive.do(Intent(throttle=1.0))
    drive.plugged.unplug("wheel")
    sdl_runtime.acquire().event.get()
    sdl_runtime.release()
    driver = drive.poll()
    assert (driver.throttle, driver.throttle_validity) == (0.0, LOST)


def test_another_joystick_that_comes_and_goes_changes_nothing(drive: Drive, plug: Plug) -> None:
    drive.do(Intent(throttle=0.5, gear=2))
    pad = plug(VirtualSpec("Pad", 0x045E, 0x028E, 6, 11, 1))
    pad.set_axis(0, 1.0)
    driver = drive.poll(3)
    pad.close()
    assert driver == drive.poll(3)._replace(neutral_ticks=driver.neutral_ticks)
    assert driver.throttle_validity == LIVE


TH8A = VirtualSpec("Thrustmaster TH8A", 0x044F, 0xB65C, 1, 8, is_wheel=False)


def test_other_shifter_plays_the_role_where_the_first_is_not_there(
    sdl: None, t500: CockpitProfile, t500_settings: CockpitSettings, plug: Plug
) -> None:
    plugged = VirtualCockpit(t500)
    plugged.unplug("shifter")
    th8a = plug(TH8A)
    source = SdlSource(t500)
    try:
        drive = Drive(plugged, source, t500_settings)
        drive.do(ticks=2)
        th8a.set_button(2, True)
        assert drive.poll().gear == 3.0
        th8a.set_button(2, False)
        assert source.instance_id("shifter") == th8a.instance_id
        th8a.detach()
        assert drive.poll(2).shifter_validity == LOST
        plugged.plug("shifter")
        assert drive.poll(3).shifter_validity == LIVE, "and the first one takes it again"
    finally:
        source.close()
        plugged.close()


def test_first_shifter_is_bound_with_the_other_beside_it(
    plugged: VirtualCockpit, plug: Plug, t500: CockpitProfile
) -> None:
    th8a = plug(TH8A)
    source = SdlSource(t500)
    assert source.instance_id("shifter") not in (None, th8a.instance_id)
    source.close()


def test_twin_of_a_bound_device_is_not_listened_to(drive: Drive, plug: Plug) -> None:
    twin = plug(drive.plugged.spec("wheel"))
    twin.set_axis(2, -1.0)
    assert drive.do(Intent(throttle=0.3), ticks=3).throttle == pytest.approx(0.3, abs=1e-4)


@pytest.mark.fault("D10")
def test_burst_of_events_ends_at_the_newest_value(drive: Drive) -> None:
    """D10: 10^4 moves and 5,000 presses between two polls."""
    wheel = drive.plugged._devices[DeviceKey(0x044F, 0xB65E)]
    for step in range(5000):
        wheel.set_axis(0, step / 5000.0)
        wheel.set_button(12, step % 2 == 0)
        wheel._sdl.SDL_JoystickUpdate()
        wheel.set_axis(0, -step / 5000.0)
    assert drive.poll().hand_wheel_rad == pytest.approx(9.4248 * 4999 / 5000, rel=1e-3)


def test_press_shorter_than_a_tick_is_not_lost(drive: Drive) -> None:
    wheel = drive.plugged._devices[DeviceKey(0x044F, 0xB65E)]
    wheel.set_button(4, True)
    wheel._sdl.SDL_JoystickUpdate()
    wheel.set_button(4, False)
    assert drive.poll().edges == float(Button.AUTONOMOUS)
    assert drive.poll().pressed == 0.0


def test_missing_device_is_named_with_what_is_there(sdl: None, plug: Plug, t500: CockpitProfile) -> None:
    with pytest.raises(DeviceNotFound, match=r"role wheel: value 044f:b65e .* not connected: nothing is$"):
        SdlSource(t500)
    plug(VirtualSpec("Thrustmaster TRS Racing wheel", 0x044F, 0xB65E, 4, 13, 1, (0.0, 1.0, 1.0, 1.0)))
    with pytest.raises(DeviceNotFound, match=r"role shifter: value 044f:b660 .* connected are 044f:b65e Thrustmaster"):
        SdlSource(t500)


def test_wheel_in_boot_mode_is_explained(plug: Plug, t500: CockpitProfile) -> None:
    plug(VirtualSpec("Thrustmaster FFB Wheel", 0x044F, 0xB65D, 2, 13, 1))
    with pytest.raises(DeviceModeError, match=r"value 044f:b65d \(boot mode\): 044f:b65e; load a driver"):
        SdlSource(t500)


def test_device_with_too_few_axes_is_refused(plug: Plug, t500: CockpitProfile) -> None:
    plug(VirtualSpec("Thrustmaster TRS Racing wheel", 0x044F, 0xB65E, 2, 13, 1))
    with pytest.raises(DeviceModeError, match="axes and buttons: value 2 and 13: at least 4 and 13"):
        SdlSource(t500)


@pytest.mark.fault("D09")
@pytest.mark.parametrize("rest", [(0.0, -1.0, -1.0, -1.0), (0.0, 1.0, -1.0, 1.0)], ids=["all", "throttle"])
def test_throttle_calibrated_the_wrong_way_round_is_refused(
    plug: Plug, t500: CockpitProfile, rest: tuple[float, ...]
) -> None:
    """D09."""
    plug(VirtualSpec("Wheel", 0x044F, 0xB65E, 4, 13, 1, rest))
    plug(VirtualSpec("Shifter", 0x044F, 0xB660, 2, 10))
    with pytest.raises(DeviceError, match=r"pedals\.throttle: value 100% pressed at the start: below 95%; foot off"):
        SdlSource(t500)


def test_foot_on_brake_and_clutch_at_the_start_is_no_fault(
    plug: Plug, t500: CockpitProfile, t500_settings: CockpitSettings
) -> None:
    plug(VirtualSpec("Wheel", 0x044F, 0xB65E, 4, 13, 1, (0.0, -1.0, 1.0, -1.0)))
    plug(VirtualSpec("Shifter", 0x044F, 0xB660, 2, 10))
    source = SdlSource(t500)
    sample = source.poll(1)
    source.close()
    s = t500_settings
    assert (sample.brake_axis, sample.clutch_axis) == (s.brake_full_raw, s.clutch_full_raw)
    assert travel(sample.throttle_axis, s.throttle_rest_raw, s.throttle_full_raw) < s.throttle_dead


def test_cockpit_without_devices_is_refused(sdl: None, t500: CockpitProfile) -> None:
    keyless = CockpitProfile(
        schema=1, title="Nothing", wheel=t500.wheel, pedals=t500.pedals, shifter=t500.shifter, roles=[]
    )
    with pytest.raises(DeviceError, match="Nothing: roles: value empty"):
        SdlSource(keyless)
    with pytest.raises(DeviceError, match="Nothing: roles: value empty"):
        VirtualCockpit(keyless)


def test_failed_opening_leaves_sdl_closed(sdl: None, t500: CockpitProfile) -> None:
    import pygame

    with pytest.raises(DeviceNotFound):
        SdlSource(t500)
    assert not pygame.joystick.get_init()
    assert not pygame.display.get_init()
