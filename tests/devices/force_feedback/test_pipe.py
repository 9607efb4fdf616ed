"""The motor's delay as a line of cells, and the wheel by the end of it."""

import msgspec
import pytest

from simconsole.devices.force_feedback.force_settings import ForceSettings, force_settings
from simconsole.devices.force_feedback.pipe import ahead, delivered, filled
from simconsole.devices.force_feedback.rim import Rim, turn
from simconsole.profiles.device import CockpitProfile
from simconsole.values.signals import MotorPipe

EMPTY = MotorPipe(*(0.0,) * len(MotorPipe._fields))


def of(t500: CockpitProfile, delay_s: float, tick_hz: int) -> ForceSettings:
    force = t500.force_feedback
    assert force is not None
    motor = msgspec.structs.replace(force.motor, delay_s=delay_s)
    changed = msgspec.structs.replace(force, motor=motor, update_hz=250)
    return force_settings(msgspec.structs.replace(t500, force_feedback=changed), 15.0, 0.6, tick_hz)


@pytest.mark.parametrize(("delay_ms", "ticks"), [(0, 0), (4, 1), (12, 3), (24, 6)])
def test_whole_ticks_are_kept_exactly(delay_ms: int, ticks: int, t500: CockpitProfile) -> None:
    force, pipe, arrived = of(t500, delay_ms / 1000.0, 250), EMPTY, []
    for tick in range(20):
        asked = 1.0 if tick == 5 else 0.0
        arrived.append(delivered(pipe, asked, force))
        pipe = filled(pipe, asked, force)
    assert arrived == pytest.approx([1.0 if tick == 5 + ticks else 0.0 for tick in range(20)])


@pytest.mark.parametrize("tick_hz", [100, 250, 500, 1000])
@pytest.mark.parametrize("delay_ms", [5, 9, 13, 22, 34])
def test_the_mean_delay_is_the_motors_and_nothing_is_lost(tick_hz: int, delay_ms: int, t500: CockpitProfile) -> None:
    force, pipe, late, total = of(t500, delay_ms / 1000.0, tick_hz), EMPTY, 0.0, 0.0
    for tick in range(400):
        asked = 1.0 if tick == 0 else 0.0
        arrived = delivered(pipe, asked, force)
        late, total = late + tick * arrived / tick_hz, total + arrived
        pipe = filled(pipe, asked, force)
    assert total == pytest.approx(1.0)
    if force.pipe_cells:
        held_s = max(0.0, 0.5 * (1.0 / 250.0 - 1.0 / tick_hz))  # on average, by the rate of updates
        assert late == pytest.approx(delay_ms / 1000.0 + held_s, rel=1e-6)


def test_what_is_on_its_way_is_foreseen(t500: CockpitProfile) -> None:
    force, pipe = of(t500, 0.024, 250), EMPTY
    for asked in (0.5, 1.0, 0.8, -0.3, 0.2, 0.6):
        pipe = filled(pipe, asked, force)
    seen = ahead(Rim(0.1, 2.0), 0.0, pipe, force)
    rim = Rim(0.1, 2.0)
    for asked in (0.5, 1.0, 0.8, -0.3, 0.2, 0.6):
        rim = turn(rim, asked, force.inertia_kgm2, force.motor_damping_nms, force.motor_friction_nm, 0.004)
    assert seen == pytest.approx(rim)
