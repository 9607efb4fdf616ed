"""Identifying the simulated wheel through virtual devices: figures, profile, provenance, refusals."""

from pathlib import Path

import msgspec
import pytest

from simconsole.devices.force_feedback.identification import Identified
from simconsole.devices.setup.device_commands import unpaced
from simconsole.devices.setup.identify_dialogue import Weight, borne_by_wheel, identified_profile, identify_motor
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load
from simconsole.values.errors import DeviceError

pytestmark = pytest.mark.usefixtures("sdl")


def quiet(line: str) -> None:
    return


def enter(question: str) -> str:
    return ""


def test_figures_come_into_a_profile_with_their_source(t500: CockpitProfile, tmp_path: Path) -> None:
    path = tmp_path / "cockpit.yaml"
    found = identify_motor(t500, path, say=quiet, ask=enter, virtual=True, pace=unpaced)
    assert found["refusal"] == ""
    assert found["torque_of_a_hatchback"].endswith("km/h"), "what this wheel bears"
    learnt = load("devices", str(path), CockpitProfile)
    assert learnt.force_feedback is not None
    motor = learnt.force_feedback.motor
    assert motor.identified == "ratios"
    assert motor.delay_s == pytest.approx(0.014, abs=0.001), "the motor's own lag of 2 ms counts"
    assert motor.inertia_kgm2 == pytest.approx(0.05, rel=0.03)
    assert motor.friction_nm == pytest.approx(0.2, rel=0.03)
    source = learnt.provenance["force_feedback.motor"]
    assert source.status == "captured"
    assert "nobody measured" in source.source
    assert learnt.provenance["force_feedback.level_pushes"].status == "captured"


def test_weight_gives_the_scale_and_the_report_says_so(t500: CockpitProfile) -> None:
    found = identify_motor(t500, None, say=quiet, ask=enter, virtual=True, pace=unpaced, weight=Weight(1.0, 0.14))
    assert found["max_torque_nm"] == pytest.approx(4.0, rel=0.02)
    assert found["scale"] == "a weight of 1 kg at 0.14 m"


def test_figure_that_no_wheel_has_is_refused_and_not_cut_to_the_next_that_one_has(t500: CockpitProfile) -> None:
    force = t500.force_feedback
    assert force is not None
    strange = Identified(0.02, 30.0, 0.0, 125.0, 0.0001)
    with pytest.raises(DeviceError, match=r"wheel: damping, N m s: value 4\.17: 0 to 2; turn it freely"):
        identified_profile(t500, force, strange, 1.0, None)


def test_share_of_a_hatchbacks_torque_falls_where_the_motor_is_late(t500: CockpitProfile) -> None:
    force = t500.force_feedback
    assert force is not None
    motor = msgspec.structs.replace(force.motor, delay_s=0.032)
    late = msgspec.structs.replace(t500, force_feedback=msgspec.structs.replace(force, motor=motor))
    assert borne_by_wheel(t500, 250).startswith("99 % at 210 km/h")
    assert borne_by_wheel(late, 250).startswith("85 % at 60 km/h, 67 % at 90 km/h")


def test_what_is_no_weight_or_no_new_file_is_refused_first(t500: CockpitProfile, tmp_path: Path) -> None:
    taken = tmp_path / "cockpit.yaml"
    taken.write_text("", encoding="ascii")
    with pytest.raises(DeviceError, match="exists"):
        identify_motor(t500, taken, say=quiet, ask=enter, virtual=True, pace=unpaced)
    with pytest.raises(DeviceError, match="weight: mass: value 20"):
        identify_motor(t500, None, say=quiet, ask=enter, virtual=True, pace=unpaced, weight=Weight(20.0, 0.14))


def test_any_key_lets_go(t500: CockpitProfile) -> None:
    asked: list[int] = []

    def pressed() -> bool:
        asked.append(1)
        return len(asked) > 1500

    with pytest.raises(KeyboardInterrupt):
        identify_motor(t500, None, say=quiet, ask=enter, virtual=True, pace=unpaced, pressed=pressed)
