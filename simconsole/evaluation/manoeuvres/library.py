"""The manoeuvres by the kind of their description."""

from simconsole.evaluation.manoeuvres.acceleration import acceleration
from simconsole.evaluation.manoeuvres.attempt import Driving
from simconsole.evaluation.manoeuvres.bend import bend_braking, lift_off
from simconsole.evaluation.manoeuvres.braking import coast_down, straight_braking
from simconsole.evaluation.manoeuvres.frequency import frequency_response
from simconsole.evaluation.manoeuvres.lane_change import lane_change
from simconsole.evaluation.manoeuvres.observed import observed
from simconsole.evaluation.manoeuvres.on_centre import parking_effort, weave
from simconsole.evaluation.manoeuvres.sine_with_dwell import sine_with_dwell
from simconsole.evaluation.manoeuvres.steering import steady_circle, step_steer
from simconsole.profiles.manoeuvre import (
    Acceleration,
    BendBraking,
    CoastDown,
    DoubleLaneChange,
    FrequencyResponse,
    LiftOff,
    Manoeuvre,
    Observed,
    ParkingEffort,
    SineWithDwell,
    SteadyCircle,
    StepSteer,
    StraightBraking,
    Weave,
)
from simconsole.values.platform import Platform


def drive_manoeuvre(spec: Manoeuvre, car: Platform, duration_s: float) -> Driving:
    """Return the running manoeuvre: it yields `Attempt`s, takes their drives and returns its `Result`.

    Args:
        spec: its description.
        car: what is driven.
        duration_s: of a scripted drive.
    """
    match spec:
        case SteadyCircle():
            return steady_circle(spec, car)
        case StepSteer():
            return step_steer(spec, car)
        case SineWithDwell():
            return sine_with_dwell(spec, car)
        case DoubleLaneChange():
            return lane_change(spec, car)
        case StraightBraking():
            return straight_braking(spec, car)
        case CoastDown():
            return coast_down(spec, car)
        case Weave():
            return weave(spec, car)
        case ParkingEffort():
            return parking_effort(spec, car)
        case FrequencyResponse():
            return frequency_response(spec, car)
        case BendBraking():
            return bend_braking(spec, car)
        case LiftOff():
            return lift_off(spec, car)
        case Acceleration():
            return acceleration(spec, car)
        case Observed():
            return observed(spec, car, duration_s)
