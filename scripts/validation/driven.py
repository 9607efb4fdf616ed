"""The driven cars: their test manoeuvres, and the figures with the range that their class has."""

from typing import Any, NamedTuple

import msgspec

from simconsole.evaluation.checks.manoeuvre_check import drive
from simconsole.profiles.files.loader import load
from simconsole.profiles.scenario import ScenarioProfile
from simconsole.profiles.vehicle import CarProfile

CARS = ("hatchback", "light_van", "commonroad_bmw320i")

NORMAN = "assisted cars; the test is that of Norman, SAE 840069, the range general knowledge"
SEGEL = (
    "assisted cars; the test is that of Norman, SAE 840069; drivers found 23 N m/g near the optimum [8]; the range "
    "around it general knowledge"
)
SHARP = "Sharp and Granger, Proc. IMechE D 217, 2003: with assistance"
ADAC = "about 500 brake tests of ADAC: mean 36.4 m, 31.3 to 47.8 m"
GENERAL = "usual of the class; general knowledge, no table was at hand"
PERFORMANCE = "cars: [1]; vans: [2]"
SINGLE_TRACK = "cars: [3] and [4], which measured 3.6 deg/g at 2.67 m; vans: none was found, that of cars"
CHARACTERISTIC = f"{SINGLE_TRACK}; taught as usual: 65 to 100 km/h [9]"
ROADHOLDING = "two hatchbacks had 0.83 g [5]; the range around it general knowledge"
ROLL = (
    "measured were 3.5 to 4.4 deg/g [6], [7]; called typical: small cars 5, large ones 7 deg/g [10]; the ranges "
    "around them general knowledge"
)
ZOMOTOR = "Zomotor, Fahrwerktechnik: Fahrverhalten; not looked up"

SOURCES = (
    "Cars of topgear.com on 24 February 2014, data set 'topgear' of github.com/STAN-UAntwerp/robpy: the eight "
    "hatchbacks with front-wheel drive of 4.1 to 4.5 m, 1175 to 1440 kg and 105 to 122 bhp. Their time is to 62 mph.",
    "Renault Kangoo of 2021, 4.49 m long, 55 to 96 kW: rad-ab.com, 30 April 2021.",
    "github.com/commaai/opendbc, the files of values and the vehicle model of its cars: the single tracks by which "
    "openpilot steers compact cars, tyre stiffness 0.385 to 0.82 of that of its reference: 1.15 to 2.45 deg/g, "
    "131 to 90 km/h at 2.7 m.",
    "K. Tse, Cornering Compliances of a Typical Road Vehicle, 2019, github.com/kktse/kktse.github.io: a front-driven "
    "saloon as its maker built it, by steady bends and pulses.",
    "Car and Driver, Performance and Driving Impressions (Hyundai Elantra GT, Volkswagen Golf), autos.yahoo.com.",
    "K. Tse, github.com/kktse/kktse.github.io, post of 21 September 2022: Toyota Prius 4.4 deg/g (R. van Hoek, "
    "Eindhoven University of Technology, 2016), Jaguar F-Pace 3.5 deg/g (MotorTrend, 2016).",
    "M. K. Salaani and G. J. Heydinger, SAE 2000-01-0700, as the validation of the simulator Skidpad "
    "reads its plots: Jeep Cherokee 3.6 deg/g.",
    "L. Segel, An Investigation of Automobile Handling as Implemented by a Variable-Steering Automobile, Human "
    "Factors, August 1964; its abstract at swov.nl: 17 ft lb/g, by five drivers in one car.",
    "euromotor.org, slides on driving dynamics (presentation 6, slide 16): characteristic velocity, of today's "
    "vehicles.",
    "A. Rastogi, On a Roll: Roll rates in a Vehicle, 7 August 2020, archit-rstg.medium.com: indicative values.",
)
"""Where ranges were read, in the order of their numbers."""


class Figure(NamedTuple):
    """A characteristic value, how it is driven, and the range of each class: cars, vans."""

    label: str
    manoeuvre: str
    value: str
    unit: str
    car: tuple[float, float]
    van: tuple[float, float]
    source: str
    factor: float = 1.0


FIGURES = (
    Figure("0 to 100 km/h", "acceleration", "time_s", "s", (9.3, 12.6), (12.0, 19.2), PERFORMANCE),
    Figure("Top speed", "acceleration", "top_speed_kmh", "km/h", (185.0, 203.0), (152.0, 183.0), PERFORMANCE),
    Figure("Braking 100 to 0 km/h", "straight_braking", "stopping_distance_m", "m", (33.0, 42.0), (36.0, 47.8), ADAC),
    Figure("Dive", "brake_gently", "pitch_angle_gradient_deg_per_g", "deg/g", (1.0, 1.7), (1.0, 1.7), GENERAL),
    Figure(
        "Understeer gradient",
        "steady_state_circle",
        "understeer_gradient_deg_per_mps2",
        "deg/g",
        (1.15, 3.6),
        (1.15, 3.6),
        SINGLE_TRACK,
        9.80665,
    ),
    Figure(
        "Characteristic speed",
        "steady_state_circle",
        "characteristic_speed_kmh",
        "km/h",
        (73.0, 131.0),
        (73.0, 131.0),
        CHARACTERISTIC,
    ),
    Figure(
        "Limit", "steady_state_circle", "highest_lateral_acceleration_mps2", "m/s²", (7.5, 9.5), (6.5, 8.5), ROADHOLDING
    ),
    Figure(
        "Roll gradient",
        "steady_state_circle",
        "roll_angle_gradient_deg_per_mps2",
        "deg/g",
        (3.0, 6.0),
        (4.0, 7.5),
        ROLL,
        9.80665,
    ),
    Figure(
        "Step: yaw rate response", "step_steer", "yaw_rate_response_time_s", "s", (0.08, 0.25), (0.08, 0.30), ZOMOTOR
    ),
    Figure("Step: overshoot", "step_steer", "yaw_rate_overshoot_percent", "%", (0.0, 30.0), (0.0, 40.0), ZOMOTOR),
    Figure(
        "Sine: frequency of the peak",
        "frequency_response",
        "yaw_rate_peak_frequency_hz",
        "Hz",
        (0.6, 1.5),
        (0.5, 1.5),
        ZOMOTOR,
    ),
    Figure("Sine: gain at the peak", "frequency_response", "yaw_rate_peak_ratio", "", (1.0, 1.8), (1.0, 2.0), ZOMOTOR),
    Figure(
        "Sine: lag at 1 Hz",
        "frequency_response",
        "yaw_rate_lag_at_1_hz_deg",
        "deg",
        (15.0, 60.0),
        (20.0, 70.0),
        ZOMOTOR,
    ),
    Figure(
        "Braking in a bend: yaw rate after 1 s",
        "bend_braking",
        "yaw_rate_ratio_at_1_s",
        "",
        (1.0, 1.3),
        (1.0, 1.3),
        ZOMOTOR,
    ),
    Figure("Lift-off: yaw rate after 1 s", "lift_off", "yaw_rate_ratio_at_1_s", "", (1.0, 1.2), (1.0, 1.2), ZOMOTOR),
    Figure(
        "Weave: gradient at 0 g",
        "weave",
        "steering_torque_gradient_at_0_g_nm_per_g",
        "N m/g",
        (15.0, 30.0),
        (15.0, 30.0),
        SEGEL,
    ),
    Figure("Weave: torque at 0.1 g", "weave", "steering_torque_at_01_g_nm", "N m", (1.5, 2.5), (1.5, 3.0), NORMAN),
    Figure("Weave: friction at 0 g", "weave", "steering_torque_at_0_g_nm", "N m", (0.5, 1.5), (0.5, 2.0), NORMAN),
    Figure(
        "Weave: lateral acceleration at 0 N m",
        "weave",
        "lateral_acceleration_at_0_nm_g",
        "g",
        (0.02, 0.08),
        (0.02, 0.08),
        NORMAN,
    ),
    Figure("Parking torque", "parking_effort", "parking_torque_nm", "N m", (2.0, 5.0), (2.0, 5.0), SHARP),
)

MANOEUVRES: dict[str, dict[str, Any]] = {
    "acceleration": {"kind": "acceleration"},
    "straight_braking": {"kind": "straight_braking", "without": False},
    "brake_gently": {"kind": "straight_braking", "without": False, "brake": 0.35},
    "steady_state_circle": {"kind": "steady_state_circle"},
    "step_steer": {"kind": "step_steer"},
    "frequency_response": {"kind": "frequency_response"},
    "bend_braking": {"kind": "bend_braking"},
    "lift_off": {"kind": "lift_off"},
    "weave": {"kind": "weave"},
    "parking_effort": {"kind": "parking_effort"},
}

AT_THE_RIM = ("weave", "parking_effort")
NOT_MODELLED = {("commonroad_bmw320i", figure.value) for figure in FIGURES if figure.manoeuvre in AT_THE_RIM}
"""CommonRoad's models have no trail and no turn slip: there is nothing at the rim to measure."""


def measured(car: str) -> dict[str, dict[str, float]]:
    """Return the values of each manoeuvre of one car; without any where it could not be driven."""
    found = {}
    for name, manoeuvre in MANOEUVRES.items():
        aids = {"features": {"aids": {"stability_control": False}}} if name == "steady_state_circle" else {}
        session = {"schema": 1, "scenario": {"vehicle": car}, "devices": {"driver": "none"}} | aids
        raw = {"schema": 1, "title": name, "duration_s": 240, "session": session, "manoeuvre": manoeuvre, "limits": []}
        scenario = msgspec.convert(raw, ScenarioProfile)
        assert scenario.manoeuvre is not None
        found[name] = dict(drive(scenario, scenario.manoeuvre).result.values)
    gradient = found["steady_state_circle"].get("understeer_gradient_deg_per_mps2", 0.0)
    if gradient > 0.0:
        wheelbase_m = load("vehicles", car, CarProfile).body.wheelbase_m
        speed_mps = (wheelbase_m / gradient * 57.29577951308232) ** 0.5
        found["steady_state_circle"]["characteristic_speed_kmh"] = 3.6 * speed_mps
    return found


def inside(figure: Figure, car: str, value: float | None) -> bool:
    """Return whether a value lies in the range of the car's class."""
    low, high = figure.van if car == "light_van" else figure.car
    return value is not None and low <= value <= high
