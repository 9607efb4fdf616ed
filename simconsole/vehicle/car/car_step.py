"""One tick of the car: the order of its parts. Every part is a kernel of its own file."""

from collections.abc import Callable
from typing import Final

from simconsole.values.ground import GROUND
from simconsole.values.kernels import Row, clip, forget, is_finite, kernel, stage
from simconsole.values.layout import read, write
from simconsole.values.platform import Step
from simconsole.values.signals import ImpactInput, ObstacleImpact, Request, VehicleCommand
from simconsole.values.state_vector import LAYOUT
from simconsole.values.trigonometry import nearest
from simconsole.vehicle.car.axles import Contact, KingpinMoment, TyreModel, kingpin_moment, tyre_forces
from simconsole.vehicle.car.body import body_step
from simconsole.vehicle.car.driveline import driveline_step
from simconsole.vehicle.car.ground import Grips, Lie, field_grips, on_field, on_plane, plane_grips
from simconsole.vehicle.car.outputs import vehicle_state
from simconsole.vehicle.car.parameters import PARAMETERS, AidParameters, CarParameters
from simconsole.vehicle.car.state import CAR, BodyState, Car, SteeringState, Wheel
from simconsole.vehicle.car.steering import hand_wheel_torque, rack_rate, rim_friction, wheel_directions
from simconsole.vehicle.car.tyre import tyre

STEP_S: Final = 0.001
"""The car integrates at 1 ms whatever the tick; its stiffest mode (a wheel on its tyre) has a period of 30 ms."""

MOST_GEARS: Final = 7.0

GripsModel = Callable[[Car, CarParameters, Row], Grips]
"""A kernel that returns the friction under each wheel: `plane_grips` or `field_grips`."""

LieModel = Callable[[Car, CarParameters, Row], Lie]
"""A kernel that returns how the ground lies under the car: `on_plane` or `on_field`."""


@kernel
def load_parameters(parameters: Row) -> CarParameters:
    """Return the parameters, read anew."""
    forget()
    return read(parameters, PARAMETERS)


def make_step(tyre: TyreModel, rim_moment: KingpinMoment, grips_of: GripsModel, lie_of: LieModel) -> Step:
    """Return the kernel that advances a car on such tyres and ground by one tick, as values/platform.py has it."""

    @stage
    def step(previous: Row, row: Row, parameters: Row, ground: Row, substeps: int) -> None:
        command = read(row, LAYOUT.command)
        car = struck(read(previous, CAR), read(row, LAYOUT.impact), read(row, LAYOUT.obstacle))
        grips = grips_of(car, load_parameters(parameters), ground)
        request = request_of(command, car)
        aids = aids_left_on(load_parameters(parameters).aids, command)
        for _ in range(substeps):
            car = substep(car, parameters, ground, grips, request, aids, tyre, rim_moment, lie_of)
        write(row, CAR, car)
        write(row, LAYOUT.vehicle, vehicle_state(car, load_parameters(parameters), ground, lie_of, command.automatic))

    return step


@kernel
def struck(car: Car, impact: ImpactInput, obstacle: ObstacleImpact) -> Car:
    """Return the car after collisions with road users and fixed things, which change its motion at once."""
    vx_mps, vy_mps = impact.vx_mps + obstacle.vx_mps, impact.vy_mps + obstacle.vy_mps
    yaw_rate_radps = impact.yaw_rate_radps + obstacle.yaw_rate_radps
    if vx_mps == 0.0 and vy_mps == 0.0 and yaw_rate_radps == 0.0:
        return car
    before = car.body
    body = BodyState(
        x_m=before.x_m,
        y_m=before.y_m,
        yaw_rad=before.yaw_rad,
        vx_mps=before.vx_mps + vx_mps,
        vy_mps=before.vy_mps + vy_mps,
        yaw_rate_radps=before.yaw_rate_radps + yaw_rate_radps,
        ax_mps2=before.ax_mps2,
        ay_mps2=before.ay_mps2,
        heave_m=before.heave_m,
        heave_mps=before.heave_mps,
        roll_rad=before.roll_rad,
        roll_radps=before.roll_radps,
        pitch_rad=before.pitch_rad,
        pitch_radps=before.pitch_radps,
        distance_m=before.distance_m,
    )
    return Car(
        body=body,
        steering=car.steering,
        fl=car.fl,
        fr=car.fr,
        rl=car.rl,
        rr=car.rr,
        shafts=car.shafts,
        box=car.box,
        aids=car.aids,
    )


@kernel
def request_of(command: VehicleCommand, car: Car) -> Request:
    """Return what a command asks of the car; an angle that is not finite leaves the rack where it is."""
    return Request(
        road_wheel_rad=command.road_wheel_rad if is_finite(command.road_wheel_rad) else car.steering.road_wheel_rad,
        throttle=pedal(command.throttle),
        brake=pedal(command.brake),
        clutch=pedal(command.clutch),
        handbrake=pedal(command.handbrake),
        gear=lever(command.gear),
        automatic=command.automatic,
        turn_indicators=command.turn_indicators,
        hazard_lights=command.hazard_lights,
    )


@kernel
def pedal(value: float) -> float:
    """Return a pedal position 0..1. The gate passes only finite values; anything else counts as released."""
    return clip(value, 0.0, 1.0) if is_finite(value) else 0.0


@kernel
def lever(gear: float) -> float:
    """Return where the lever is: -1, 0 or 1 to 7. Anything else, and anything between two gears, counts as neutral."""
    if is_finite(gear) and -1.0 <= gear <= MOST_GEARS and nearest(gear) == gear:
        return gear
    return 0.0


@kernel
def aids_left_on(aids: AidParameters, command: VehicleCommand) -> AidParameters:
    """Return the driver aids with those off that somebody has switched off."""
    return AidParameters(
        anti_lock=0.0 if command.anti_lock_off > 0.0 else aids.anti_lock,
        traction=0.0 if command.traction_off > 0.0 else aids.traction,
        stability=0.0 if command.stability_off > 0.0 else aids.stability,
        hill_hold=aids.hill_hold,
        understeer_per_square_mps=aids.understeer_per_square_mps,
        lateral_mps2=aids.lateral_mps2,
        stability_nms=aids.stability_nms,
        stability_most_nm=aids.stability_most_nm,
    )


@kernel
def with_aids(p: CarParameters, aids: AidParameters) -> CarParameters:
    """Return the parameters with these driver aids."""
    return CarParameters(
        body=p.body,
        steering=p.steering,
        engine=p.engine,
        gears=p.gears,
        aids=aids,
        front=p.front,
        rear=p.rear,
    )


@kernel
def substep(
    car: Car,
    parameters: Row,
    ground: Row,
    grips: Grips,
    request: Request,
    aids: AidParameters,
    tyre: TyreModel,
    rim_moment: KingpinMoment,
    lie_of: LieModel,
) -> Car:
    """Advance the car by 1 ms: steer, push against the ground, turn the shafts, move."""
    rack = car.steering
    p = load_parameters(parameters)
    lie = lie_of(car, p, ground)
    # The rack works against the tyres of the last step: their moment is part of the rack's torque.
    mean_rad = rack.road_wheel_rad + STEP_S * rack.road_wheel_radps
    points = wheel_directions(p.steering, mean_rad)
    turned_rad = mean_rad - rack.road_wheel_rad
    axles = tyre_forces(car, p, grips, lie, points, turned_rad, STEP_S, tyre, rim_moment)
    moved = SteeringState(
        road_wheel_rad=mean_rad,
        road_wheel_radps=rack.road_wheel_radps,
        hand_wheel_torque_nm=rack.hand_wheel_torque_nm,
        patch_twist_rad=axles.patch_twist_rad,
        rim_friction_share=rim_friction(p.steering, rack.rim_friction_share, turned_rad),
    )
    rate = rack_rate(p.steering, moved, request.road_wheel_rad, axles.aligning_nm)
    torque = hand_wheel_torque(p.steering, axles.aligning_nm, rate, car.body.vx_mps, moved.rim_friction_share)
    line = driveline_step(car, with_aids(load_parameters(parameters), aids), request, axles, STEP_S)
    motion = body_step(car, load_parameters(parameters), lie, read(ground, GROUND.plane), axles, STEP_S)
    front = motion.front
    rear = motion.rear
    brakes = line.brakes
    return Car(
        body=motion.body,
        steering=SteeringState(
            road_wheel_rad=mean_rad,
            road_wheel_radps=rate,
            hand_wheel_torque_nm=torque,
            patch_twist_rad=moved.patch_twist_rad,
            rim_friction_share=moved.rim_friction_share,
        ),
        fl=wheel(axles.fl, line.fl_radps, front.left_m, front.left_mps, brakes.fl_nm),
        fr=wheel(axles.fr, line.fr_radps, front.right_m, front.right_mps, brakes.fr_nm),
        rl=wheel(axles.rl, line.rl_radps, rear.left_m, rear.left_mps, brakes.rl_nm),
        rr=wheel(axles.rr, line.rr_radps, rear.right_m, rear.right_mps, brakes.rr_nm),
        shafts=line.shafts,
        box=line.box,
        aids=line.aids,
    )


@kernel
def wheel(on_ground: Contact, radps: float, lift_m: float, lift_mps: float, brake_nm: float) -> Wheel:
    """Return a wheel after its step."""
    return Wheel(
        radps=radps,
        deflection_x_m=on_ground.tyre.deflection_x_m,
        deflection_y_m=on_ground.tyre.deflection_y_m,
        lift_m=lift_m,
        lift_mps=lift_mps,
        brake_nm=brake_nm,
    )


step: Final = make_step(tyre, kingpin_moment, plane_grips, on_plane)
"""The step of a car on a plane whose tyres the profile describes itself."""

field_step: Final = make_step(tyre, kingpin_moment, field_grips, on_field)
"""The same on a field of heights."""
