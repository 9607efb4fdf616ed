"""Runs behind the mocked kernel: the console's own motor on SDL's own driver, 250 ticks a second.

python haptic_program.py HOW [BACK_END [watched]]      HOW: drive, hang (SIGSTOP to itself), kill (SIGKILL to itself),
contract (port_contract.py), pause (of a drive, under force), motion (read what the kernel plays) or limits (what it
says of the axes)
"""

import json
import os
import signal
import sys

import msgspec
import numpy as np

from simconsole.devices.calibration.cockpit_settings import NOBODY
from simconsole.devices.force_feedback.motor import WheelMotor
from simconsole.devices.haptics.back_ends import open_motor
from simconsole.devices.haptics.watchdog_client import Watchdog, with_watchdog
from simconsole.devices.sources import sdl_runtime
from simconsole.devices.sources.kernel_limits import notes, problems, read_limits
from simconsole.devices.sources.sdl_source import JoystickInfo, SdlSource, connected_joysticks
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load
from simconsole.profiles.force_feedback import ForceFeedback
from simconsole.session.resolution import load_session, resolve
from simconsole.tick.assembly import assemble
from simconsole.values.host.jit import plain
from simconsole.values.signals import NO_SAMPLE, NO_TORQUE, Event, EventInput, Mode, Validity
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT, Snapshot
from tests.devices.port_contract import CHECKS
from tests.patience import pause, stamp_ns

PAUSE_S = 0.4
LEVELS = [0.0, 0.5, 1.0, -1.0, -0.25, 9.0, -9.0, 0.0]
BACK_END = sys.argv[2] if len(sys.argv) > 2 else "sdl"
FORCE = ForceFeedback(max_torque_nm=4.0, back_end=BACK_END)  # type: ignore[arg-type]  # sdl or evdev


def shot(torque_nm: float, enabled: float = 1.0) -> Snapshot:
    row = np.zeros(PLATFORM_AT)
    row[LAYOUT.torque.slice] = NO_TORQUE._replace(torque_nm=torque_nm, ramp=1.0, enabled=enabled)
    return Snapshot(1, 250, row)


def motion() -> None:
    """Print one line of JSON for each new sample of a second."""
    cockpit = load("devices", "t500rs_th8rs", CockpitProfile)
    wheel, pedals, shifter = cockpit.roles
    same = {"vendor_id": wheel.vendor_id, "product_id": wheel.product_id}  # only the wheel stands behind the mock
    roles = [wheel, pedals, msgspec.structs.replace(shifter, **same)]
    source = SdlSource(msgspec.structs.replace(cockpit, roles=roles))
    before = None
    for tick in range(1, 301):
        sample = source.poll(tick)
        if sample != before:
            print(json.dumps(sample._asdict()), flush=True)
        before = sample
        pause(0.004)
    source.close()


def main(how: str) -> None:
    pygame = sdl_runtime.acquire()
    pygame.event.get()
    ((entry, joystick),) = connected_joysticks(pygame)
    print(entry, joystick.get_instance_id(), flush=True)
    if how == "contract":
        contract(entry)
        return
    port = open_motor(entry.instance_id, (entry.vendor_id, entry.product_id), FORCE)
    print(port.capability, flush=True)
    watchdog = None
    if sys.argv[3:] == ["watched"]:
        watchdog = Watchdog((entry.vendor_id, entry.product_id))
        port = with_watchdog(port, watchdog)
        pause(0.5)  # until it has opened the device
        print("watchdog", watchdog.process_id, flush=True)
    motor = WheelMotor(port, FORCE, lambda snapshot: stamp_ns() / 1e9)
    if how == "pause":
        stand(motor)
        motor.close()
        sdl_runtime.release()
        return
    for level in LEVELS:
        for _ in range(5):
            motor.publish(shot(4.0 * level))
            pause(0.004)
    if how == "hang":
        motor.publish(shot(4.0))
        os.kill(os.getpid(), signal.SIGSTOP)
    if how == "kill":
        motor.publish(shot(4.0))
        os.kill(os.getpid(), signal.SIGKILL)
    motor.close()
    motor.close()
    if watchdog is not None:
        watchdog.close()
    sdl_runtime.release()


def stand(motor: WheelMotor) -> None:
    """A car in a bend pulls at the wheel; time stands for PAUSE_S, as `drive.run` lets it stand, and goes on."""
    console, state = assemble(resolve(load_session("demo")), plain)
    assert console.force_feedback is not None
    row = state.vector
    for tick in range(1, 401):
        before, row = row, row.copy()
        events = {301: Event.PAUSE, 302: Event.START}.get(tick, Event(0))
        row[LAYOUT.events.slice] = EventInput(float(events))
        row[LAYOUT.sample.slice] = NO_SAMPLE._replace(wheel_motor=1.0)
        row[LAYOUT.driver.slice] = NOBODY._replace(wheel_validity=float(Validity.LIVE))
        row[LAYOUT.arbitration.start] = float(Mode.MANUAL)
        row[LAYOUT.vehicle.slice] = console.platform.initial_vehicle._replace(vx_mps=20.0, hand_wheel_torque_nm=3.0)
        console.force_feedback(before, row, console.settings, console.tick_s)
        if tick > 250:
            motor.publish(Snapshot(tick, 250, row))
            pause(0.004)
        if tick == 301:
            print("stands", stamp_ns(), flush=True)
            pause(PAUSE_S)
            print("goes on", stamp_ns(), flush=True)


def contract(entry: JoystickInfo) -> None:
    """Print what came of each check, each on a motor just opened: empty where it holds."""
    outcome = {}
    for name, check in CHECKS.items():
        port = open_motor(entry.instance_id, (entry.vendor_id, entry.product_id), FORCE)
        assert port.capability.constant, port.capability.name
        try:
            check(port)
        except Exception as error:  # noqa: BLE001  # whatever it is, the test says it
            outcome[name] = repr(error)
        else:
            outcome[name] = ""
        port.close()
    print(json.dumps(outcome), flush=True)


def limits() -> None:
    """Print what the kernel says of the wheel."""
    cockpit = load("devices", "t500rs_th8rs", CockpitProfile)
    found = read_limits((0x044F, 0xB65E))
    print(json.dumps([found._asdict(), problems(found, cockpit), notes(found)]), flush=True)


if __name__ == "__main__":
    if sys.argv[1] == "motion":
        motion()
    elif sys.argv[1] == "limits":
        limits()
    else:
        main(sys.argv[1])
