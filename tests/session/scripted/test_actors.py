import numpy as np
import pytest

from tests.session.scripted.drives import ASKS, ENGAGED, driven

LEAD = """\
actors:
  - name: lead
    x_m: 30
    y_m: 0
    speed_kmh: 18
    acts:
      - {{{trigger}, speed_kmh: 0, accel_mps2: 6}}
"""


def braked(trigger: str) -> tuple[float, np.ndarray, np.ndarray]:
    """When a lead vehicle brakes, and gap and speed of the drive behind it."""
    drive = driven(f"{ENGAGED}events:\n{ASKS}{LEAD.format(trigger=trigger)}", seconds=14)
    speed, gap = drive.column("ahead.lead_speed_mps"), drive.column("ahead.lead_gap_m")
    slower = np.flatnonzero(speed < 4.9)
    assert gap[0] == pytest.approx(30.0 - 2.25 - 3.4, abs=0.6), "from bumper to bumper"
    return (float(slower[0]) / 250 if len(slower) else np.inf), gap, drive.column("vehicle.vx_mps")


def test_a_lead_vehicle_brakes_at_a_time() -> None:
    at_s, _, _ = braked("at_s: 3")
    assert at_s == pytest.approx(3.0, abs=0.1)


def test_a_lead_vehicle_brakes_once_it_is_near() -> None:
    at_s, gap, _ = braked("gap_below_m: 20")
    assert gap[int(at_s * 250) - 25] < 20.0 + 1.0
    assert (gap[: int(at_s * 250) - 40] > 20.0).all()


def test_a_lead_vehicle_brakes_by_its_own_way_and_not_before_its_time() -> None:
    assert braked("at_distance_m: 10, of: lead")[0] == pytest.approx(2.0, abs=0.1)
    assert braked("at_distance_m: 10, of: lead, not_before_s: 4")[0] == pytest.approx(4.0, abs=0.1)


def test_the_gap_of_two_is_between_their_middles_or_their_bumpers() -> None:
    middles = braked("gap_below_m: 20, to: lead")[0]
    bumpers = braked("gap_below_m: 20, to: lead, bumper_to_bumper: true")[0]
    assert bumpers < middles
    assert braked("gap_below_m: 20, of: lead")[0] == middles, "the same two"


def test_it_is_run_into() -> None:
    drive = driven(f"{ENGAGED}events:\n{ASKS}actors: [{{name: wall, x_m: 25, y_m: 0}}]\n", seconds=8)
    touched = np.flatnonzero(drive.column("impact.first_touch"))
    assert len(touched) == 1
    assert drive.column("vehicle.vx_mps")[touched[0] + 1] < drive.column("vehicle.vx_mps")[touched[0] - 1] - 1.0
