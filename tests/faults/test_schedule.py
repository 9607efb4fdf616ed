"""Faults of a scenario: when they are on, that every kind is served, that a drive with them replays bit for bit."""

from pathlib import Path
from typing import Any, Final, NamedTuple, get_args

import numpy as np
import pytest

from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.sources.trace_files import TraceWriter
from simconsole.devices.synthetic.script import ScriptSource
from simconsole.devices.synthetic.trace_format import TraceHeader
from simconsole.evaluation.metrics.fault_metrics import fault_spans
from simconsole.evaluation.metrics.table import drive_of
from simconsole.faults.schedule import SERVES, FaultClock
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.faults import Fault, Onset, Place, Stuck, fault_label
from simconsole.profiles.files.loader import load, parse, to_text
from simconsole.profiles.parts.script import ScriptProfile
from simconsole.profiles.person import PersonPlan
from simconsole.profiles.scenario import ScenarioProfile
from simconsole.profiles.session import Devices, ModeSection, Outputs, SessionProfile
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.session.lifecycle import drive
from simconsole.session.resolution import resolve
from simconsole.values.errors import ProfileError
from simconsole.values.signals import Event, Mode
from simconsole.values.state_vector import Snapshot, columns
from tests.evaluation.in_memory import drive_scenario

TICK_HZ: Final = 100
ALL_KINDS = """\
- {kind: unplug, device: shifter, at_s: 0.2, for_s: 0.2}
- {kind: freeze, device: wheel, at_s: 0.5, for_s: 0.2}
- {kind: stuck, axis: throttle, raw: -1.0, at_s: 0.8, for_s: 0.1}
- {kind: swapped, axis: throttle, other: brake, at_s: 0.9, for_s: 0.1}
- {kind: noise, axis: wheel, amplitude_raw: 0.05, seed: 4, at_s: 1.0, for_s: 0.4}
- {kind: late, device: pedals, by_ms: 40, at_s: 1.1, for_s: 0.2}
- {kind: invalid, axis: brake, at_s: 1.3, for_s: 0.04}
- {kind: burst, device: wheel, events_per_s: 2000, at_s: 1.4, for_s: 0.1}
- {kind: two_gears, gear: 3, on_mode: manual, delay_s: 1.0, for_s: 0.1}
"""


class Nothing(NamedTuple):
    nothing: float


NAMES = columns(Nothing)


def snapshot(tick: int, **values: float) -> Snapshot:
    row = np.zeros(len(NAMES))
    for name, value in values.items():
        row[NAMES.index(name.replace("__", "."))] = value
    return Snapshot(tick, TICK_HZ, row)


def on_ticks(onset: Onset, snapshots: list[Snapshot]) -> list[int]:
    clock = FaultClock([onset], TICK_HZ)  # type: ignore[list-item]  # the clock looks at the onset alone
    return [before.tick + 1 for before in snapshots if clock.turn(before.tick + 1, before)]


def test_a_fault_by_time_is_on_for_its_duration() -> None:
    quiet = [snapshot(tick) for tick in range(100)]
    assert on_ticks(Onset(at_s=0.5, for_s=0.1), quiet) == list(range(50, 60))
    assert on_ticks(Onset(at_s=0.5, delay_s=0.2, for_s=0.001), quiet) == [70], "one tick at least"
    assert on_ticks(Onset(at_s=0.9), quiet) == list(range(90, 101)), "to the end"
    assert on_ticks(Onset(at_s=0.0, for_s=0.05), quiet) == [1, 2, 3, 4]


@pytest.mark.parametrize(
    ("onset", "values"),
    [
        (Onset(at_distance_m=12.0, for_s=0.03), {"vehicle__distance_m": 12.0}),
        (Onset(near=Place(x_m=10.0, y_m=-4.0, radius_m=2.0), for_s=0.03), {"vehicle__x_m": 9.0, "vehicle__y_m": -5.0}),
        (Onset(on_mode="autonomous", for_s=0.03), {"arbitration__mode": float(Mode.AUTONOMOUS)}),
        (Onset(on_event="mark", for_s=0.03), {"events__events": float(Event.MARK | Event.RESET)}),
    ],
    ids=["distance", "place", "mode", "event"],
)
def test_a_fault_by_what_happens_begins_in_the_next_tick_once(onset: Onset, values: dict[str, float]) -> None:
    before = [snapshot(tick) for tick in range(20)]
    there = [snapshot(tick, **values) for tick in range(20, 40)]
    again = [snapshot(40), *(snapshot(tick, **values) for tick in range(41, 60))]
    assert on_ticks(onset, before + there + again) == [21, 22, 23]


def test_the_mask_has_the_bit_of_each_place() -> None:
    clock = FaultClock(
        [Stuck(axis="wheel", at_s=0.02), Stuck(axis="brake", at_s=0.01, for_s=0.02), Stuck(axis="clutch", at_s=9.0)],
        TICK_HZ,
    )
    assert [clock.turn(tick, snapshot(tick - 1)) for tick in range(1, 5)] == [2.0, 3.0, 1.0, 1.0]


def test_every_kind_has_a_layer_and_every_layer_a_kind_of_the_list() -> None:
    assert set(SERVES) == set(get_args(Fault))
    assert len({kind.__struct_config__.tag for kind in SERVES}) == len(SERVES)


def session(faults: str, **devices: Any) -> SessionProfile:
    listed = parse(f"schema: 1\nscenario:\n  duration_s: 2.5\n  faults:\n{_indented(faults)}", SessionProfile, "s.yaml")
    return SessionProfile(
        schema=1,
        scenario=listed.scenario,
        devices=Devices(**devices),
        outputs=Outputs(hud=None, scene=None, report=False),
        mode=ModeSection(tick_hz=TICK_HZ, pacing="free"),
    )


def _indented(text: str) -> str:
    return "".join(f"    {line}\n" for line in text.splitlines())


@pytest.mark.parametrize(
    ("fault", "message"),
    [
        ("{kind: unplug, device: wheel}", ": no trigger given, must be exactly one of at_s"),
        ("{kind: unplug, device: wheel, at_s: 1, on_mode: manual}", ": at_s and on_mode given"),
        (
            "{kind: unplug, device: seat, at_s: 1}",
            'faults[0].device: value "seat": one of handbrake, pedals, shifter, wheel',
        ),
        ("{kind: unplugg, device: wheel, at_s: 1}", 'faults[0].kind: value "unplugg": one of unplug, freeze, stuck,'),
        ("{kind: stuck, axis: wheel, raw: 3, at_s: 1}", "faults[0].raw: value 3: a number from -1 to 1 or null"),
        ("{kind: stuck, axis: wheel, raw: 0, at: 1}", "faults[0].at: value 1: unknown key"),
        ("{kind: late, device: wheel, by_ms: 0, at_s: 1}", "faults[0].by_ms: value 0: a number, above 0 and 5000"),
        ("{kind: two_gears, gear: 0, at_s: 1}", ": gear 0 must be -1 or 1 to 7"),
        ("{kind: swapped, axis: wheel, other: wheel, at_s: 1}", ": other wheel must be another axis"),
    ],
)
def test_a_wrong_fault_is_refused_with_file_key_and_range(fault: str, message: str) -> None:
    with pytest.raises(ProfileError) as refused:
        session(f"- {fault}")
    assert str(refused.value).startswith("s.yaml: ")
    assert message in str(refused.value)


SCRIPT = parse(
    "points:\n- {time_s: 0, throttle: 0, brake: 0, clutch: 0, hand_wheel_deg: 0, gear: 0}\n"
    "- {time_s: 0.1, clutch: 1, gear: 1}\n- {time_s: 0.6, throttle: 0.3, hand_wheel_deg: 20}\n"
    "- {time_s: 2.5, clutch: 0, throttle: 0.3}\n",
    ScriptProfile,
    "script",
)


def scenario(faults: str) -> ScenarioProfile:
    return ScenarioProfile(schema=1, title="faults", duration_s=2.5, session=session(faults), script=SCRIPT)


def test_a_scenario_is_driven_with_its_faults_and_tells_when_each_was_on() -> None:
    profile = scenario(ALL_KINDS)
    recorder, names = drive_scenario(profile)
    drive = drive_of(recorder.vectors, names, TICK_HZ)
    faults = profile.session.scenario.faults
    spans = {
        span.fault: (span.first_tick, span.last_tick) for span in fault_spans(drive, [fault_label(f) for f in faults])
    }
    assert spans.pop("two_gears gear 3")[1] < 250
    assert spans == {
        "unplug device shifter": (20, 39),
        "freeze device wheel": (50, 69),
        "stuck axis throttle raw -1.0": (80, 89),
        "swapped axis throttle other brake": (90, 99),
        "noise axis wheel amplitude_raw 0.05 seed 4": (100, 139),
        "late device pedals by_ms 40.0 stamped True": (110, 129),
        "invalid axis brake reading not_a_number": (130, 133),
        "burst device wheel events_per_s 2000 amplitude_raw 0.1 seed 1": (140, 149),
    }
    assert np.isnan(drive.column("sample.brake_axis")[129:133]).all()
    assert np.isfinite(drive.column("command.brake")).all()


def test_the_same_faults_give_the_same_drive_and_another_seed_another() -> None:
    one, again, other = (
        drive_scenario(scenario(text))[0] for text in (ALL_KINDS, ALL_KINDS, ALL_KINDS.replace("seed: 4", "seed: 5"))
    )
    assert one.digest == again.digest
    assert one.digest != other.digest


@pytest.mark.parametrize("driver", ["script", "trace", "virtual"])
def test_a_drive_with_faults_replays_bit_for_bit_whatever_the_source(tmp_path: Path, driver: str) -> None:
    result = drive(resolve(session(ALL_KINDS, **seated(driver, tmp_path))), tmp_path / "bundle")
    replayed = replay_bundle(tmp_path / "bundle")
    table = open_bundle(tmp_path / "bundle").log.table()
    assert replayed.hashes_equal, replayed.differences
    assert (result.ticks, replayed.ticks) == (250, 250)
    assert np.isnan(table.column("sample.brake_axis")).sum() == 4
    assert len(set(table.column("events.faults"))) > 9


def seated(driver: str, folder: Path) -> dict[str, Any]:
    """A driver of this kind, with what it needs in `folder`."""
    if driver == "virtual":
        return {"driver": driver, "person": parse("{sit_s: 0.2, stop: {distance_m: 100}}", PersonPlan, "p.yaml")}
    path = folder / f"{driver}.yaml"
    if driver == "script":
        path.write_text(to_text(SCRIPT))
    else:
        source = ScriptSource(
            SCRIPT, cockpit_settings(load("devices", "t500rs_th8rs", CockpitProfile), TICK_HZ), tick_hz=TICK_HZ
        )
        with TraceWriter(path, TraceHeader(TICK_HZ, "test")) as writer:
            for tick in range(1, 251):
                writer.write(tick, source.poll(tick))
    return {"driver": f"{driver}:{path}"}
