"""Every scenario that is shipped passes, and all of them together are driven within three minutes of processor time.

The sample drives all but those that repeat another, in their share of the time.
"""

import os
import subprocess
import sys
from importlib import import_module

from simconsole.evaluation.checks.selection import selected
from tests.drives.fixtures import REPEATED, Checked
from tests.paths import ROOT
from tests.samples import Sample

FOLDER = ROOT / "profiles" / "scenarios"
CPU_S = 180.0
AGAIN = ("traffic/stop_and_go", "roads/signals_autopilot", "by_hand/behind_a_lead")


def test_they_are_enough_and_of_every_kind() -> None:
    names = selected([str(FOLDER)])
    assert len(names) >= 60
    for kind in ("by_hand", "hand_over", "faults", "handling", "roads", "traffic"):
        assert sum(f"/{kind}/" in name for name in names) >= 5, kind


def test_they_pass_within_three_minutes_of_processor_time(sample: Sample, checked: Checked) -> None:
    shipped = len(selected([str(FOLDER)]))
    assert len(checked.scenarios) == sample.of(shipped - len(REPEATED), shipped)
    failed = {path: one["problems"] for path, one in checked.scenarios.items() if not one["passed"]}
    assert failed == {}
    print(f"measured: {len(checked.scenarios)} scenarios in {checked.cpu_s:.0f} s of processor time")
    assert checked.cpu_s < CPU_S * len(checked.scenarios) / shipped


def test_a_drive_is_the_same_to_the_bit_on_another_processor(sample: Sample) -> None:
    numpy_core = import_module("numpy._core._multiarray_umath")
    held = [feature for feature in numpy_core.__cpu_dispatch__ if numpy_core.__cpu_features__[feature]]
    plain = {**os.environ, "NPY_DISABLE_CPU_FEATURES": " ".join(held), "OPENBLAS_CORETYPE": "Nehalem"}
    paths = [str(FOLDER / f"{name}.yaml") for name in AGAIN[: sample.of(1, len(AGAIN))]]
    command = [sys.executable, "-m", "simconsole", "check", *paths]
    done = subprocess.run(command, env=plain, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
