"""The driven cars: their test manoeuvres, and the figures with the range that their class has."""

from typing import Any, NamedTuple

import msgspec

from simconsole.evaluation.checks.manoeuvre_check import drive
from simconsole.profiles.files.loader import load
from simconsole.profiles.scenario import ScenarioProfile
from simconsole.profiles.vehicle import CarProfile

CARS = ("hatchback", "light_van", "commonroad_bmw320i")

NONE = "no published range found; engineering estimate"
NORMAN = f"assisted cars; the test is that of Norman, SAE 840069; {NONE}"
SEGEL = (
    "assisted cars; the test is that of Norman, SAE 840069; drivers found 23 N m/g near the optimum [8]; around it: "
    f"{NONE}"
)
PARKING = (
    "assisted cars; makers let workshops find at most 6 N m [12], 7.8 N m [13], 29 to 34 N at the rim, 5.4 to 6.3 N m "
    f"at 0.185 m [14], [20], [21]; the narrower range and its low end: {NONE}"
)
DIVE = (
    "no published range found; the fronts of saloons dipped by 6 cm when they braked hard from 32 km/h [22], by "
    "estimate 1.1 to 2 deg/g; engineering estimate"
)
BRAKES = (
    "about 500 tests of ADAC: mean 36.4 m, best of the Golf class 33.1 m, worst of the vans 47.8 m [15]; an older Golf "
    "39.5 m [16]; large vans of 2003 and 2007 44 to 47.4 m, reckoned from other speeds [23], [24]; the ends within "
    "that: engineering estimate"
)
PERFORMANCE = "cars: [1]; vans: [2]"
TOP_SPEED = f"{PERFORMANCE}; the BMW 320i of 1990 itself: 214 km/h [17]"
SINGLE_TRACK = "cars: [3] and [4], which measured 3.6 deg/g at 2.67 m; vans: no published range found, that of cars"
CHARACTERISTIC = f"{SINGLE_TRACK}; taught as usual: 65 to 100 km/h [9]"
ROADHOLDING = (
    "two hatchbacks had 0.83 g [5], a tall estate on solid axles 7.05 m/s² [7], the best of five large vans 0.78 g, "
    "7.65 m/s² [24]; the ranges around them: engineering estimate"
)
ROLL = (
    "measured were 3.5 to 4.4 deg/g [6], [7]; called typical: small cars 5, large ones 7 deg/g [10]; the ranges "
    "around them: engineering estimate"
)
TRANSIENT = "cars: single tracks of [3], [4] and [11], computed"
RESPONSE = f"{TRANSIENT}; vans: up to the 0.28 s that a tall estate had at 43 km/h [7]"
OVERSHOOT = f"{TRANSIENT}; vans: down to the 0.8 % of [7]"
PEAK = f"{TRANSIENT}: 0.6 to 1 Hz, without tyres' lag and roll; cars: 1 to 1.5 Hz [18]; vans: {NONE}"
GAIN = f"{TRANSIENT}; taught, for a speed that is not told: 1.26 to 1.58, the less the better damped [19]; vans: {NONE}"
LAG = f"{TRANSIENT}; taught, for a speed that is not told: 20 to 40 deg [19]; vans: {NONE}"

SOURCES = (
    "Cars of topgear.com on 24 February 2014, data set 'topgear' of github.com/STAN-UAntwerp/robpy: the eight "
    "hatchbacks with front-wheel drive of 4.1 to 4.5 m, 1175 to 1440 kg and 105 to 122 bhp. Their time is to 62 mph.",
    "Renault Kangoo of 2021, 4.49 m long, 55 to 96 kW: rad-ab.com, 30 April 2021.",
    "github.com/commaai/opendbc, the files of values and the vehicle model of its cars: the single tracks by which "
    "openpilot steers compact cars, tyre stiffness 0.385 to 0.82 of that of its reference: 1.15 to 2.45 deg/g, "
    "131 to 90 km/h at 2.7 m.",
    "K. Tse, Cornering Compliances of a Typical Road Vehicle, 2019, github.com/kktse/kktse.github.io: a front-driven "
    "saloon as its maker built it (Acura TSX of 2007), by steady bends and pulses.",
    "Car and Driver, Performance and Driving Impressions (Hyundai Elantra GT, Volkswagen Golf), autos.yahoo.com.",
    "K. Tse, github.com/kktse/kktse.github.io, post of 21 September 2022: Toyota Prius 4.4 deg/g (R. van Hoek, "
    "Eindhoven University of Technology, 2016), Jaguar F-Pace 3.5 deg/g (MotorTrend, 2016).",
    "M. K. Salaani and G. J. Heydinger, SAE 2000-01-0700, as the validation of the simulator Skidpad "
    "reads its plots (github.com/CS-Software-LLC/skidpad, docs/validation/nhtsa-jeep-cherokee.md): NHTSA's Jeep "
    "Cherokee of 1997: roll 3.6 deg/g, 7.05 m/s² at most, yaw rate 0.28 s from half of the step to 90 %, "
    "overshoot 0.8 %.",
    "L. Segel, An Investigation of Automobile Handling as Implemented by a Variable-Steering Automobile, Human "
    "Factors, August 1964; its abstract at swov.nl: 17 ft lb/g, by five drivers in one car.",
    "euromotor.org, slides on driving dynamics (presentation 6, slide 16): characteristic velocity, of today's "
    "vehicles.",
    "A. Rastogi, On a Roll: Roll rates in a Vehicle, 7 August 2020, archit-rstg.medium.com: indicative values.",
    "K. Tse, Cornering Compliances and Transients, 2019, github.com/kktse/kktse.github.io: Honda Civic Si of 2012, "
    "set up for the race track, by steady bends and pulses.",
    "Opel Corsa C, check of effort on a steering wheel: corsa-c.ru, 5.2.2.",
    "Mazda 3 of 2022, workshop manual, steering force inspection: lemon.leoquadpod.com.",
    "Honda Jazz and Fit, workshop manual, power steering assist check: hondafitjazzge6ge8.automotive-manuals.com.",
    "autogazette.de, October 2016, and nachrichten-muenchen.de, on the brake tests of ADAC in four years.",
    "motor-talk.de, Der Golf-Kombi bremst besser als ein Audi R8: Golf IV of 2001, by ADAC.",
    "BMW Group Classic, BMW 320i (E36): bmwgroup-classic.com.",
    "Daisharin, the encyclopedia of cars of San'ei Shobo, 2004, at weblio.jp: frequency response (handling).",
    "bibble-babble.cocolog-nifty.com, 625. frequency response, 13 June 2015: passenger cars, 2 to 4 dB at the peak, "
    "1 to 1.3 Hz.",
    "Mitsubishi Outlander of 2014, workshop manual, steering force, 29 N: mitsubishi.automotive-manuals.com; Suzuki "
    "Kizashi of 2010, 30 N: lemon-manuals.gy.",
    "Hyundai Accent LC, check of effort on a steering wheel, 34.3 N: hyundaibook.ru.",
    "D. Aylor and others, Limitations of Current Bumper Designs and Potential Improvements, SAE 2005-01-1337: mean of "
    "the saloons.",
    "trucktrend.com, comparison of minivans, 2003: 135 to 145 ft from 60 mph.",
    "Car and Driver, November 2007, on the Nissan Quest, as blog.hondacarsrockhill.com quotes it on 5 December 2007: "
    "the best of five minivans, 0.78 g and 186 ft from 70 mph.",
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
    Figure("Top speed", "acceleration", "top_speed_kmh", "km/h", (185.0, 203.0), (152.0, 183.0), TOP_SPEED),
    Figure("Braking 100 to 0 km/h", "straight_braking", "stopping_distance_m", "m", (33.0, 42.0), (36.0, 47.8), BRAKES),
    Figure("Dive", "brake_gently", "pitch_angle_gradient_deg_per_g", "deg/g", (1.0, 1.7), (1.0, 1.7), DIVE),
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
        "Step: yaw rate response",
        "step_steer",
        "yaw_rate_response_time_s",
        "s",
        (0.138, 0.186),
        (0.138, 0.28),
        RESPONSE,
    ),
    Figure("Step: overshoot", "step_steer", "yaw_rate_overshoot_percent", "%", (4.4, 32.6), (0.8, 32.6), OVERSHOOT),
    Figure(
        "Sine: frequency of the peak",
        "frequency_response",
        "yaw_rate_peak_frequency_hz",
        "Hz",
        (0.6, 1.5),
        (0.5, 1.5),
        PEAK,
    ),
    Figure("Sine: gain at the peak", "frequency_response", "yaw_rate_peak_ratio", "", (1.0, 1.43), (1.0, 2.0), GAIN),
    Figure(
        "Sine: lag at 1 Hz",
        "frequency_response",
        "yaw_rate_lag_at_1_hz_deg",
        "deg",
        (25.9, 44.3),
        (20.0, 70.0),
        LAG,
    ),
    Figure(
        "Braking in a bend: yaw rate after 1 s",
        "bend_braking",
        "yaw_rate_ratio_at_1_s",
        "",
        (1.0, 1.3),
        (1.0, 1.3),
        NONE,
    ),
    Figure("Lift-off: yaw rate after 1 s", "lift_off", "yaw_rate_ratio_at_1_s", "", (1.0, 1.2), (1.0, 1.2), NONE),
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
    Figure("Parking torque", "parking_effort", "parking_torque_nm", "N m", (2.0, 5.0), (2.0, 5.0), PARKING),
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
