"""The motor's delay: torque that is on its way, and the wheel by the time that what is asked for now arrives.

Pure kernels. The delay is a line of cells through which torque moves at an even pace (an upwind scheme: exact where
the delay is as many ticks as cells, a little smoothed between).
"""

from simconsole.devices.force_feedback.force_settings import ForceSettings
from simconsole.devices.force_feedback.rim import Rim, turn
from simconsole.values.kernels import kernel
from simconsole.values.signals import MotorPipe


@kernel
def cell(pipe: MotorPipe, number: float) -> float:
    """Return the torque in a cell, 1 being the one that is filled first."""
    if number > 5.0:
        return pipe.cell_6_nm
    if number > 4.0:
        return pipe.cell_5_nm
    if number > 3.0:
        return pipe.cell_4_nm
    if number > 2.0:
        return pipe.cell_3_nm
    if number > 1.0:
        return pipe.cell_2_nm
    return pipe.cell_1_nm


@kernel
def delivered(pipe: MotorPipe, asked_nm: float, force: ForceSettings) -> float:
    """Return what acts on the wheel over a tick at whose beginning `asked_nm` was asked for."""
    return cell(pipe, force.pipe_cells) if force.pipe_cells > 0.0 else asked_nm


@kernel
def filled(pipe: MotorPipe, asked_nm: float, force: ForceSettings) -> MotorPipe:
    """Return the cells after a tick at whose beginning `asked_nm` was asked for."""
    share = force.pipe_share
    return MotorPipe(
        cell_1_nm=pipe.cell_1_nm + share * (asked_nm - pipe.cell_1_nm),
        cell_2_nm=pipe.cell_2_nm + share * (pipe.cell_1_nm - pipe.cell_2_nm),
        cell_3_nm=pipe.cell_3_nm + share * (pipe.cell_2_nm - pipe.cell_3_nm),
        cell_4_nm=pipe.cell_4_nm + share * (pipe.cell_3_nm - pipe.cell_4_nm),
        cell_5_nm=pipe.cell_5_nm + share * (pipe.cell_4_nm - pipe.cell_5_nm),
        cell_6_nm=pipe.cell_6_nm + share * (pipe.cell_5_nm - pipe.cell_6_nm),
    )


@kernel
def ahead(rim: Rim, human_nm: float, pipe: MotorPipe, force: ForceSettings) -> Rim:
    """Return the wheel by the time that torque asked for now acts on it.

    Args:
        rim: As estimated now.
        human_nm: The person's torque, taken to last.
        pipe: What has been asked for and is to come.
        force: Of this drive.
    """
    cells = int(force.pipe_cells)
    for back in range(cells):
        rim = turn(
            rim,
            cell(pipe, force.pipe_cells - back) + human_nm,
            force.inertia_kgm2,
            force.motor_damping_nms,
            force.motor_friction_nm,
            force.pipe_cell_s,
        )
    return rim
