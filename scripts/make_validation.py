"""Write docs/validation.md, every number measured anew: `python scripts/make_validation.py [docs/validation.md]`.

Half a minute. With --json the figures are also printed as one JSON object, for the test that holds them to bounds.
"""

import argparse
import json
from pathlib import Path
from typing import Any

from validation import oracles
from validation.peers import Compared, compare

PAGE = Path(__file__).resolve().parents[1] / "docs" / "validation.md"

INTRODUCTION = """# Validation of the car

Written by `scripts/make_validation.py`, which measures every number on this page; nobody types one. What the numbers
must be is asserted by `tests/vehicle/test_validation.py` and, on fresh random inputs each time, by
`tests/vehicle/test_car_commonroad.py`. What the shipped cars do in test manoeuvres, beside the ranges of their
classes, the torque at the rim among it, is in [driven_cars.md](driven_cars.md).

## Beside CommonRoad's models

commonroad-vehicle-models 3.0.2 has a kinematic (KS), a single-track (ST), a drifting single-track (STD) and a
multi-body model (MB) of one car. `profiles/vehicles/commonroad_bmw320i.yaml` gives our car its parameters, with what
theirs have not (drag, rolling resistance, load sensitivity) switched off. All models get the same input: the front
wheels turn within {ramp} s, then hold. Distances are the largest ones of the centres of gravity from that of MB within
{duration} s; theirs are integrated by Runge-Kutta 4 at {peer_step} ms, ours at its 1 ms.
"""

LIMITS = """## Known limits

- Roll and pitch are small angles and end in stops: a car that turns over leans on them and comes back.
- The ground is a plane with one slope, and x and y are measured along it; a wheel meets no kerb, no pothole and no
  loose surface.
- Tyres have no temperature, wear, pressure or inflation; turn slip exists at the steered wheels only.
- Suspension is springs, dampers, bars and stops at each wheel, with one slope of the links of each axle for braking and
  driving alike; no compliance steer but the rack's, no bushings.
- The driveline is stiff behind the clutch: no shunt, no half-shaft twist.
- Driver aids know the true speed over ground, as a perfect estimator would tell it.
- The hatchback is nobody's car. Its figures are typical or invented (each says which), so its agreement with a
  measured car is unknown; what is validated is that the equations do what they should with the figures they get.
- CommonRoad's models are an opinion too: they stand still, reverse and brake to rest badly or not at all, so only
  moderate driving in motion is compared.
"""


def page(compared: list[Compared], found: dict[str, dict[str, float]]) -> str:
    """Return the page."""
    from validation.peers import DURATION_S, PEER_STEP_S, RAMP_S

    head = INTRODUCTION.format(ramp=RAMP_S, duration=DURATION_S, peer_step=f"{PEER_STEP_S * 1000:g}")
    return "\n".join((head, _peers(compared), _oracles(found), LIMITS))


def _peers(compared: list[Compared]) -> str:
    lines = [
        "| speed / m/s | wheels / rad | lateral / m/s² | ours / m | ST / m | STD / m | KS / m | ours of ST's "
        "| yaw rate ours, ST, STD, KS over MB's |",
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for one in compared:
        gaps = " | ".join(f"{one.gaps_m[name]:.3f}" for name in ("ours", "ST", "STD", "KS"))
        rates = one.yaw_rates_radps
        shares = ", ".join(f"{rates[name] / rates['MB']:.4f}" for name in ("ours", "ST", "STD", "KS"))
        share = one.gaps_m["ours"] / one.gaps_m["ST"]
        lines.append(
            f"| {one.speed_mps:g} | {one.angle_rad:g} | {one.lateral_mps2:.2f} | {gaps} | {share:.2f} | {shares} |"
        )
    return "\n".join((*lines, ""))


def _oracles(found: dict[str, dict[str, float]]) -> str:
    a, b, s = found["ackermann"], found["bicycle"], found["static_loads"]
    e, m, c = found["energy"], found["mirror"], found["convergence"]
    at = f"at {b['speed_mps']:g} m/s"
    complex_theory = f"{b['eigenvalue_real_theory']:.2f} ± {b['eigenvalue_imaginary_theory']:.2f}i"
    complex_found = f"{b['eigenvalue_real_measured']:.2f} ± {b['eigenvalue_imaginary_measured']:.2f}i"
    errors = ", ".join(f"{c[f'error_{step}_ms_m'] * 1000:.1f} mm at {step} ms" for step in ("2", "1", "0.5"))
    rows = [
        ("Circle at walking pace: Ackermann radius", f"{a['theory_m']:.3f} m", f"{a['measured_m']:.3f} m", a["error"]),
        (f"Bicycle {at}: eigenvalues / 1/s", complex_theory, complex_found, b["error"]),
        (
            f"Bicycle {at}: yaw gain / 1/s",
            f"{b['yaw_gain_theory_per_s']:.3f}",
            f"{b['yaw_gain_measured_per_s']:.3f}",
            b["gain_error"],
        ),
        (
            "Braked uphill: load of the front axle",
            f"{s['front_theory_n']:.1f} N",
            f"{s['front_measured_n']:.1f} N",
            s["error"],
        ),
        ("Rolling down without losses: motion over height", "1", f"{e['gained_over_height']:.4f}", e["error"]),
    ]
    lines = ["## Beside theory", "", "| Oracle | theory | measured | off by |", "| --- | --- | --- | --- |"]
    lines += [f"| {name} | {theory} | {measured} | {error * 100.0:.2f} % |" for name, theory, measured, error in rows]
    return "\n".join(
        (
            *lines,
            "",
            "The bicycle is the linear single-track model; the car beside it is the validation car made low and stiff,",
            "with tyres that answer within a few centimetres. What rolls down without losses is watched until it is",
            f"{e['end_mps']:.1f} m/s fast.",
            "",
            "- Energy: a sliding car that nobody drives never gains motion; the largest rise is "
            f"{e['largest_rise_share']:.1e} of what it had.",
            f"- Mirror symmetry: of {m['compared']:.0f} values of a drive and its mirror image, {m['error']:.0f} "
            "differ in any bit.",
            f"- Convergence: after one second of a step steer the position is off by {errors}; the order is "
            f"{c['order']:.2f}.",
            "",
        )
    )


def main() -> None:
    """Measure and write."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("page", type=Path, nargs="?", default=PAGE)
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    names = ("ackermann", "bicycle", "static_loads", "energy", "mirror", "convergence")
    found: dict[str, dict[str, Any]] = {name: getattr(oracles, name)() for name in names}
    compared = compare()
    given.page.write_text(page(compared, found), encoding="utf-8")
    if given.json:
        print(json.dumps({"oracles": found, "peers": [one._asdict() for one in compared]}))


if __name__ == "__main__":
    main()
