"""Whether a console goes into its emergency stop, and lets the wheel go, with what a cockpit sent."""

from collections.abc import Sequence

import msgspec

from simconsole.devices.setup.cockpit_trials import HZ, Verdict
from simconsole.profiles.device import CockpitProfile
from simconsole.session.resolution import load_session, resolve
from simconsole.tick.advance import advance_vector
from simconsole.tick.assembly import assemble
from simconsole.values.host.jit import plain
from simconsole.values.signals import NO_COMMAND, NO_EVENTS, DeviceSample, Mode
from simconsole.values.state_vector import Snapshot, TickInputs, input_vector


def stops(cockpit: CockpitProfile, samples: Sequence[DeviceSample]) -> Verdict:
    """Feed a console with samples, at the rate of the trials, and judge its mode and the wheel's torque at the end."""
    session = load_session("seated")
    session = msgspec.structs.replace(session, mode=msgspec.structs.replace(session.mode, tick_hz=HZ))
    resolved = msgspec.structs.replace(resolve(session), cockpit=cockpit)
    console, state = assemble(resolved, plain)
    row, modes = state.vector, []
    for sample in samples:
        inputs = TickInputs(sample._replace(wheel_motor=1.0), NO_COMMAND, NO_EVENTS)
        row = advance_vector(row, input_vector(inputs), console)
        modes.append(Mode(int(Snapshot(0, HZ, row).arbitration.mode)))
    torque_nm = Snapshot(0, HZ, row).torque.torque_nm
    ok = modes[-1] == Mode.EMERGENCY_STOP and torque_nm == 0.0
    how = "the console stops and lets the wheel go" if ok else f"the console is in {modes[-1].name}"
    return Verdict(ok, how, {"mode": modes[-1].name, "torque_nm": torque_nm})
