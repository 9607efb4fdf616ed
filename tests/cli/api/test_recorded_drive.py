"""A finished drive from Python: columns, frames, metrics, events, plots."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from simconsole import Drive, SimConsoleError, open_drive
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.pack import pack
from tests.drives.fixtures import Demo


@pytest.fixture(scope="module")
def drive(short: Path) -> Drive:
    return open_drive(short)


def test_columns_are_those_of_the_log(drive: Drive, short: Path) -> None:
    table = open_bundle(short).log.table()
    assert drive.columns == table.columns
    assert (drive.ticks, drive.tick_hz) == (750, 250)
    assert drive.time_s[[0, -1]].tolist() == [0.004, 3.0]
    assert drive.column("vehicle.vx_mps").tolist() == table.column("vehicle.vx_mps").tolist()
    arrays = drive.arrays("vehicle.*", "driver.throttle")
    wanted = [name for name in table.columns if name.startswith("vehicle.") or name == "driver.throttle"]
    assert list(arrays) == wanted
    assert all((values == table.column(name)).all() for name, values in arrays.items())
    assert len(drive.arrays()) == len(table.columns)


def test_a_packed_drive_is_the_same(drive: Drive, short: Path, tmp_path: Path) -> None:
    shutil.copytree(short, tmp_path / "packed")
    pack(tmp_path / "packed")
    packed = open_drive(tmp_path / "packed")
    assert packed.digest == drive.digest
    assert (packed.column("vehicle.x_m") == drive.column("vehicle.x_m")).all()


def test_a_column_that_there_is_not_is_told_with_those_that_there_are(drive: Drive) -> None:
    with pytest.raises(SimConsoleError, match=r"column: value 'vehicel\.\*': fits no column of sample, ros"):
        drive.arrays("vehicel.*")


def test_what_is_no_bundle_is_told(tmp_path: Path) -> None:
    with pytest.raises(SimConsoleError, match="manifest"):
        open_drive(tmp_path)


def test_frames_hold_the_same_columns(drive: Drive) -> None:
    frame = drive.pandas("vehicle.vx_mps", "driver.*")
    assert frame.index.name == "time_s"
    assert frame["vehicle.vx_mps"].to_numpy().tolist() == drive.column("vehicle.vx_mps").tolist()
    other = drive.polars("vehicle.vx_mps", "driver.*")
    assert other.columns == ["time_s", *frame.columns]
    assert other["vehicle.vx_mps"].to_list() == drive.column("vehicle.vx_mps").tolist()
    assert other["time_s"].to_list() == frame.index.tolist()


def test_metrics_are_those_of_the_report(demo: Demo) -> None:
    """The program has told those of the report that it wrote, among its own results."""
    found = json.loads(json.dumps(open_drive(demo.bundle).metrics))
    assert len(found) > 10
    assert {name: demo.results[name] for name in found} == found


def test_events_are_every_edge_and_every_change_of_mode(demo: Demo) -> None:
    drive = open_drive(demo.bundle)
    assert [event.tick for event in drive.events] == sorted(event.tick for event in drive.events)
    changes = [event for event in drive.events if event.name == "mode"]
    table = demo.table("arbitration.mode", "events.events")
    mode = table.column("arbitration.mode")
    assert len(changes) == 1 + np.count_nonzero(np.diff(mode))
    edges = [event for event in drive.events if event.name not in ("mode", "refused")]
    masks = table.column("events.events").astype(int)
    assert len(edges) == sum(mask.bit_count() for mask in masks.tolist())


def test_plots_are_figures_of_matplotlib_in_the_reports_style(drive: Drive, tmp_path: Path) -> None:
    drive.plot().savefig(tmp_path / "traces.png")
    drive.plot_map().savefig(tmp_path / "map.svg")
    assert (tmp_path / "traces.png").stat().st_size > 10_000
    assert "<svg" in (tmp_path / "map.svg").read_text()
    assert len(drive.plot().axes) == 4
    assert "<svg" in vars(type(drive.plot()))["_repr_svg_"](drive.plot())


def test_a_notebook_shows_its_figures(drive: Drive) -> None:
    shown = drive._repr_html_()
    assert "distance_m" in shown
    assert "750 ticks, 3 s" in shown
    assert "<script" not in shown


def test_it_replays(drive: Drive) -> None:
    assert drive.replay().hashes_equal
