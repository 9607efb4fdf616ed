"""The cockpit of a session: a wheel without a motor drives on and says so; a simulated one has its motor on it."""

import resource
from contextlib import ExitStack
from pathlib import Path

import msgspec
import pytest

from simconsole.devices.force_feedback.motor import MotorisedSource, WheelMotor
from simconsole.devices.setup import device_commands
from simconsole.devices.sources import kernel_limits
from simconsole.devices.sources.virtual_cockpit import VirtualCockpit
from simconsole.session.resolution import load_session, resolve
from simconsole.session.seat import look_for_devices, open_cockpit
from simconsole.tick.assembly import ResolvedSession, assemble
from simconsole.values.errors import DeviceError
from simconsole.values.host.jit import plain
from simconsole.values.key_codes import Key
from tests.drives.console import complaint, simconsole


def session(driver: str) -> ResolvedSession:
    demo = load_session("demo")
    return resolve(msgspec.structs.replace(demo, devices=msgspec.structs.replace(demo.devices, driver=driver)))


def test_wheel_without_force_feedback_drives_on_and_says_so(capsys: pytest.CaptureFixture[str]) -> None:
    resolved = session("sdl")
    with ExitStack() as stack:
        cockpit = VirtualCockpit(resolved.cockpit)
        stack.callback(cockpit.close)
        opened = open_cockpit(resolved, assemble(resolved, plain)[0], stack)
        assert "simconsole: no force feedback: wheel: force feedback: value none" in capsys.readouterr().err
        sample = opened.devices.poll(1)
        assert (sample.wheel_age_ticks, sample.wheel_motor) == (0.0, 0.0)
        cockpit.unplug("wheel")
        assert opened.devices.poll(2).wheel_age_ticks > 1e6
        cockpit.plug("wheel")
        ages = [opened.devices.poll(tick).wheel_age_ticks for tick in (3, 4)]
        assert ages[-1] == 0.0, "back by identity, its motor asked for anew"


def test_cockpit_without_the_section_has_no_motor_worker() -> None:
    resolved = session("sdl")
    bare = msgspec.structs.replace(resolved, cockpit=msgspec.structs.replace(resolved.cockpit, force_feedback=None))
    with ExitStack() as stack:
        stack.callback(VirtualCockpit(bare.cockpit).close)
        console, _ = assemble(bare, plain)
        opened = open_cockpit(bare, console, stack)
        assert opened.outputs == ()
        assert console.force_feedback is None
        assert "044f:b65e" in [device.usb_id for device in opened.identities]


@pytest.mark.parametrize(("driver", "cockpit"), [("sdl", "gamepad"), ("keyboard", "keyboard")])
def test_keys_and_sticks_are_told_the_speed(driver: str, cockpit: str) -> None:
    """They steer a fast car less: the source is an output of the drive as well."""
    demo = load_session("demo")
    devices = msgspec.structs.replace(demo.devices, driver=driver, cockpit=cockpit, person=None)
    resolved = resolve(msgspec.structs.replace(demo, devices=devices))
    with ExitStack() as stack:
        if driver == "sdl":
            stack.callback(VirtualCockpit(resolved.cockpit).close)
        console, _ = assemble(resolved, plain)
        opened = open_cockpit(resolved, console, stack, lambda: (int(Key.STEER_LEFT), 0))
        assert opened.outputs == (opened.devices,)
        assert opened.devices.poll(1).wheel_age_ticks == 0.0


def test_simulated_person_sits_at_a_wheel_with_a_motor() -> None:
    resolved = session("virtual")
    with ExitStack() as stack:
        opened = open_cockpit(resolved, assemble(resolved, plain)[0], stack)
        (motor,) = opened.outputs
        assert isinstance(motor, WheelMotor)
        assert {role for device in opened.identities for role in device.roles} >= {"wheel", "pedals"}
        assert isinstance(opened.devices, MotorisedSource)
        assert opened.devices.poll(1).wheel_motor == 1.0
    assert not motor.obeys, "closed with the session"


@pytest.mark.parametrize(("range_deg", "wrong"), [(1080.0, False), (900.0, True)])
def test_check_and_drive_call_the_same_an_error(range_deg: float, wrong: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """A wheel whose driver is set to another range steers the car wrong: neither lets it pass, in the same words."""
    limits = kernel_limits.KernelLimits((), range_deg)
    for module in (kernel_limits, device_commands):
        monkeypatch.setattr(module, "wheel_limits", lambda cockpit: limits)
    resolved = session("sdl")
    line = "wheel.lock_to_lock_deg: value 1080: 900, what the wheel's driver is set to"
    with ExitStack() as stack:
        stack.callback(VirtualCockpit(resolved.cockpit).close)
        checked = device_commands.check_devices(
            resolved.cockpit, say=lambda said: None, duration_s=0.2, pace=lambda tick: None
        )
        assert (line in checked["problems"]) is wrong
        if wrong:
            with pytest.raises(DeviceError) as caught:
                look_for_devices(resolved)
            assert str(caught.value) == f"{resolved.cockpit.title}: {line}"
        else:
            look_for_devices(resolved)


def test_drive_without_a_wheel_answers_before_it_compiles_anything(tmp_path: Path) -> None:
    """An empty home holds no compiled kernels: to compile them takes a minute. The bound is of CPU time."""
    homes = {"HOME": str(tmp_path), "XDG_CACHE_HOME": str(tmp_path)}
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = simconsole("drive", "--driver", "sdl", "--out", tmp_path / "out", **homes)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    assert "role wheel: value 044f:b65e" in complaint(done)
    assert not (tmp_path / "out").exists()
    assert after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime < 3.0
