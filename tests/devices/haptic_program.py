"""Runs behind the mocked kernel: the console's own motor on SDL's own driver, 250 ticks a second.

python haptic_program.py HOW [BACK_END [watched]]      HOW: drive, hang (SIGSTOP to itself), kill (SIGKILL to itself),
contract (port_contract.py), motion (read what the kernel plays) or limits (what it says of the axes)
"""

import json
import os
import signal
import sys
import time

import msgspec
import numpy as np

from simconsole.devices import sdl_runtime
from simconsole.devices.back_ends import open_motor
from simconsole.devices.kernel_limits import notes, problems, read_limits
from simconsole.devices.motor import WheelMotor
from simconsole.devices.sdl import Found, SdlSource, found
from simconsole.devices.watched import Watchdog, watched
from simconsole.profile_files import load
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.force_feedback import ForceFeedback
from simconsole.rows import MOTOR_AT, PLATFORM_AT, TORQUE_AT, Snapshot
from simconsole.signals import NO_TORQUE
from tests.devices.port_contract import CHECKS

LEVELS = [0.0, 0.5, 1.0, -1.0, -0.25, 9.0, -9.0, 0.0]
BACK_END = sys.argv[2] if len(sys.argv) > 2 else "sdl"
FORCE = ForceFeedback(max_torque_nm=4.0, back_end=BACK_END)  # type: ignore[arg-type]  # sdl or evdev


def shot(torque_nm: float, enabled: float = 1.0) -> Snapshot:
    row = np.zeros(PLATFORM_AT)
    row[TORQUE_AT:MOTOR_AT] = NO_TORQUE._replace(torque_nm=torque_nm, ramp=1.0, enabled=enabled)
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
        time.sleep(0.004)
    source.close()


def main(how: str) -> None:
    pygame = sdl_runtime.acquire()
    pygame.event.get()
    ((entry, joystick),) = found(pygame)
    print(entry, joystick.get_instance_id(), flush=True)
    if how == "contract":
        contract(entry)
        return
    port = open_motor(entry.instance_id, (entry.vendor_id, entry.product_id), FORCE)
    print(port.capability, flush=True)
    watchdog = None
    if sys.argv[3:] == ["watched"]:
        watchdog = Watchdog((entry.vendor_id, entry.product_id))
        port = watched(port, watchdog)
        time.sleep(0.5)  # until it has opened the device
        print("watchdog", watchdog.process_id, flush=True)
    motor = WheelMotor(port, FORCE, lambda snapshot: time.monotonic())
    for level in LEVELS:
        for _ in range(5):
            motor.publish(shot(4.0 * level))
            time.sleep(0.004)
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


def contract(entry: Found) -> None:
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
