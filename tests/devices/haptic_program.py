"""Runs behind the mocked kernel: the console's own motor on SDL's own driver, 250 ticks a second.

python haptic_program.py HOW      HOW: drive, hang (SIGSTOP to itself) or kill (SIGKILL to itself)
"""

import os
import signal
import sys
import time

import numpy as np

from simconsole.devices import sdl_runtime
from simconsole.devices.haptics import open_haptics
from simconsole.devices.motor import WheelMotor
from simconsole.devices.sdl import found
from simconsole.profiles.force_feedback import ForceFeedback
from simconsole.rows import MOTOR_AT, PLATFORM_AT, TORQUE_AT, Snapshot
from simconsole.signals import WheelTorque

LEVELS = [0.0, 0.5, 1.0, -1.0, -0.25, 9.0, -9.0, 0.0]
FORCE = ForceFeedback(max_torque_nm=4.0)


def shot(torque_nm: float, enabled: float = 1.0) -> Snapshot:
    row = np.zeros(PLATFORM_AT)
    row[TORQUE_AT:MOTOR_AT] = WheelTorque(torque_nm, 0.0, 0.0, 1.0, 0.0, enabled, 0.0, 0.0)
    return Snapshot(1, 250, row)


def main(how: str) -> None:
    pygame = sdl_runtime.acquire()
    pygame.event.get()
    ((entry, joystick),) = found(pygame)
    print(entry, joystick.get_instance_id(), flush=True)
    port = open_haptics(entry.instance_id, FORCE)
    print(port.capability, flush=True)
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
    sdl_runtime.release()


if __name__ == "__main__":
    main(sys.argv[1])
