"""The cockpit of a session: a wheel without a motor drives on and says so; a simulated one has its motor on it."""

from contextlib import ExitStack

import msgspec
import pytest

from simconsole.devices.force_feedback.motor import MotorisedSource, WheelMotor
from simconsole.devices.sources.virtual_cockpit import VirtualCockpit
from simconsole.session.resolution import load_session, resolve
from simconsole.session.seat import open_seating
from simconsole.tick.assembly import ResolvedSession, assemble
from simconsole.values.host.jit import plain


def session(driver: str) -> ResolvedSession:
    demo = load_session("demo")
    return resolve(msgspec.structs.replace(demo, devices=msgspec.structs.replace(demo.devices, driver=driver)))


def test_wheel_without_force_feedback_drives_on_and_says_so(capsys: pytest.CaptureFixture[str]) -> None:
    resolved = session("sdl")
    with ExitStack() as stack:
        cockpit = VirtualCockpit(resolved.cockpit)
        stack.callback(cockpit.close)
        seating = open_seating(resolved, assemble(resolved, plain)[0], stack)
        assert "simconsole: no force feedback: wheel: force feedback: value none" in capsys.readouterr().err
        sample = seating.devices.poll(1)
        assert (sample.wheel_age_ticks, sample.wheel_motor) == (0.0, 0.0)
        cockpit.unplug("wheel")
        assert seating.devices.poll(2).wheel_age_ticks > 1e6
        cockpit.plug("wheel")
        ages = [seating.devices.poll(tick).wheel_age_ticks for tick in (3, 4)]
        assert ages[-1] == 0.0, "back by identity, its motor asked for anew"


def test_cockpit_without_the_section_has_no_motor_worker() -> None:
    resolved = session("sdl")
    bare = msgspec.structs.replace(resolved, cockpit=msgspec.structs.replace(resolved.cockpit, force_feedback=None))
    with ExitStack() as stack:
        stack.callback(VirtualCockpit(bare.cockpit).close)
        console, _ = assemble(bare, plain)
        seating = open_seating(bare, console, stack)
        assert seating.outputs == ()
        assert console.force_feedback is None
        assert "044f:b65e" in [device.usb_id for device in seating.identities]


def test_simulated_person_sits_at_a_wheel_with_a_motor() -> None:
    resolved = session("virtual")
    with ExitStack() as stack:
        seating = open_seating(resolved, assemble(resolved, plain)[0], stack)
        (motor,) = seating.outputs
        assert isinstance(motor, WheelMotor)
        assert {role for device in seating.identities for role in device.roles} >= {"wheel", "pedals"}
        assert isinstance(seating.devices, MotorisedSource)
        assert seating.devices.poll(1).wheel_motor == 1.0
    assert not motor.obeys, "closed with the session"
