"""The layout of a tick: derived from the signals, without gap or overlap, and read back by the snapshot's views."""

from typing import NamedTuple

import numpy as np

from simconsole.values.state_vector import INPUT_WIDTH, LAYOUT, PLATFORM_AT, Snapshot, columns


class PlatformState(NamedTuple):
    """Stands for a vehicle's own columns."""

    spin_radps: float


def test_columns_are_named_by_stage_and_field_once_each() -> None:
    names = columns(PlatformState)
    assert len(names) == len(set(names)) == PLATFORM_AT + 1
    assert names[0] == "sample.wheel_axis"
    assert names[-1] == "platform.spin_radps"
    assert all(name.count(".") == 1 for name in names)


def test_stages_follow_each_other_without_gap_and_inputs_come_first() -> None:
    at = 0
    for part in LAYOUT:
        assert part.start == at
        at += part.width
    assert at == PLATFORM_AT
    inputs = {name.partition(".")[0] for name in columns(PlatformState)[:INPUT_WIDTH]}
    assert inputs == {"sample", "ros", "events", "ecu", "ahead", "impact"}
    assert columns(PlatformState)[INPUT_WIDTH].startswith("driver.")


def test_views_of_a_snapshot_show_the_columns_of_their_stage() -> None:
    row = np.arange(float(PLATFORM_AT))
    snapshot = Snapshot(750, 250, row)
    for stage, part in LAYOUT._asdict().items():
        if hasattr(snapshot, stage):
            view = getattr(snapshot, stage)
            start = columns(PlatformState).index(f"{stage}.{part.names[0]}")
            assert view == part.record(*row[start : start + len(view)])
    assert (snapshot.t_ns, snapshot.t_s) == (3_000_000_000, 3.0)
