"""Every description finds its manoeuvre."""

import pytest

from simconsole.evaluation.manoeuvres.library import drive_manoeuvre
from simconsole.profiles.manoeuvre import Observed, SineWithDwell, StraightBraking
from tests.evaluation.manoeuvres.driven import CAR


@pytest.mark.parametrize(
    ("spec", "kind"),
    [(Observed(), "observed"), (SineWithDwell(), "sine_with_dwell"), (StraightBraking(), "straight_braking")],
)
def test_every_description_finds_its_manoeuvre(spec: Observed | SineWithDwell | StraightBraking, kind: str) -> None:
    at_work = drive_manoeuvre(spec, CAR, 1.0)
    assert at_work.gi_code.co_name == kind  # type: ignore[attr-defined]  # of a generator function
