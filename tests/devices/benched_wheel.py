"""A wheel on a bench in steps of 1 ms, read before each torque acts, with a weight on its right side if wanted."""

import math
from collections import deque
from functools import cache

from simconsole.devices.force_feedback.identification import identify
from simconsole.devices.force_feedback.rim import Rim, turn
from simconsole.devices.setup.identify_dialogue import identified_profile
from simconsole.profiles.force_feedback import ForceFeedback
from simconsole.values.kernels import approach
from tests.devices.hands_off import Draw, session_of, true_force

TICK_HZ = 250
LAG_S = 0.002
COUNT_RAD = math.radians(0.0165)


class BenchedWheel:
    """One wheel."""

    def __init__(self, force: ForceFeedback, draw: Draw) -> None:
        self.true = true_force(force, draw)
        self.scale = self.true.max_torque_nm / force.max_torque_nm
        self.wire = deque([0.0] * draw.delay_ms)
        self.rim = Rim(0.0, 0.0)
        self.motor_nm = self.pull_nm = self.hung_nm = 0.0
        self.furthest_rad = self.fastest_radps = 0.0

    def take_off(self) -> None:
        self.hung_nm = 0.0

    def turn(self, torque_nm: float) -> float:
        seen = round(self.rim.rad / COUNT_RAD) * COUNT_RAD
        motor = self.true.motor
        for _ in range(1000 // TICK_HZ):
            self.pull_nm = approach(self.pull_nm, self.hung_nm, 0.0004)
            self.wire.append(torque_nm * self.scale)
            self.motor_nm += (self.wire.popleft() - self.motor_nm) * 0.001 / (0.001 + LAG_S)
            pulled = self.motor_nm - self.pull_nm * math.cos(self.rim.rad)
            self.rim = turn(self.rim, pulled, motor.inertia_kgm2, motor.damping_nms, motor.friction_nm, 0.001)
            self.furthest_rad = max(self.furthest_rad, abs(self.rim.rad))
            self.fastest_radps = max(self.fastest_radps, abs(self.rim.radps))
        return seen


@cache
def found_force(shipped: ForceFeedback, draw: Draw) -> ForceFeedback:
    """Return the profile as the identification of that wheel leaves it, without a weight: the scale is believed."""
    found = identify(BenchedWheel(shipped, draw).turn, shipped, 0.4, TICK_HZ)
    force = identified_profile(session_of("hatchback").cockpit, shipped, found, 1.0, None).force_feedback
    assert force is not None
    return force
