"""Drives into other tools' formats and bags into traces, from the command line."""

import csv
import json
import shutil
from pathlib import Path

import pytest

from simconsole.cli.main import main
from tests.drives.console import results, simconsole


def run(*words: object) -> int:
    return main([str(word) for word in words])


def test_an_export_lies_beside_the_bundle_which_stays_as_it_is(short: Path, tmp_path: Path) -> None:
    bundle = Path(shutil.copytree(short, tmp_path / "drive"))
    done = simconsole("export", bundle, "--to", "mcap", "--layout", "--json")
    assert done.returncode == 0, done.stderr
    found = results(done)
    assert found["path"] == str(tmp_path / "drive.mcap")
    assert found["layout"] == [str(tmp_path / "drive.layout.json")]
    assert (found["counts"]["/odom"], found["problems"]) == (150, [])
    assert sorted(path.name for path in tmp_path.iterdir()) == ["drive", "drive.layout.json", "drive.mcap"]
    assert run("verify", bundle) == 0


def test_columns_rate_units_and_labels(short: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "drive.csv"
    words = ("--columns", "vehicle.v*", "arbitration.mode", "--rate", 10, "--units", "display", "--labels")
    assert run("export", short, "--to", "csv", "--out", path, *words, "--json") == 0
    assert json.loads(capsys.readouterr().out.splitlines()[-1])["counts"] == {"rows": 30}
    with path.open(newline="") as file:
        head = next(csv.reader(file))
    assert head == ["tick", "time_s", "arbitration.mode_label", "vehicle.vx_kmh", "vehicle.vy_kmh"]


def test_without_choices_a_table_is_everything(short: Path, tmp_path: Path) -> None:
    from pyarrow import parquet

    assert run("export", short, "--to", "parquet", "--out", tmp_path / "drive.parquet") == 0
    table = parquet.read_table(tmp_path / "drive.parquet")
    assert table.num_rows == 750
    assert table.num_columns == 2 + 304


def test_a_recording_that_is_not_the_whole_drive_is_exported_and_said_to_be_so(
    short: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    spoilt = Path(shutil.copytree(short, tmp_path / "spoilt"))
    content = bytearray((spoilt / "drive.log").read_bytes())
    content[-2000] ^= 1
    (spoilt / "drive.log").write_bytes(content)
    assert run("export", spoilt, "--to", "csv", "--json") == 1
    found = json.loads(capsys.readouterr().out.splitlines()[-1])
    assert found["counts"] == {"rows": 749}
    assert "damaged" in found["problems"][0]


@pytest.mark.parametrize(
    ("words", "wrong"),
    [
        (("--to", "csv", "--columns", "vehicle.wings"), "--columns: value 'vehicle.wings': fits no column"),
        (("--to", "csv", "--rate", "1000"), "--rate: value 1000: above 0 to 250"),
        (("--to", "mcap", "--rate", "10"), "--to mcap: columns, rate, units, labels: only csv, parquet"),
        (("--to", "parquet", "--layout"), "--to parquet: layout: only mcap, rosbag2"),
    ],
)
def test_what_cannot_be_exported_is_one_line(
    short: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], words: tuple[str, ...], wrong: str
) -> None:
    assert run("export", short, "--out", tmp_path / "out", *words) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.startswith(f"simconsole export: {wrong}")
    assert len(said.err.splitlines()) == 1
    assert not (tmp_path / "out").exists()


def test_a_joystick_becomes_a_trace(short: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("export", short, "--to", "mcap", "--out", tmp_path / "drive.mcap") == 0
    words = ("import", tmp_path / "drive.mcap", "--out", tmp_path / "t.csv")
    assert run(*words, "--json") == 0
    assert json.loads(capsys.readouterr().out.splitlines()[-1]) == {
        "trace": str(tmp_path / "t.csv"),
        "ticks": 750,
        "tick_hz": 250,
    }
    for wrong, said in (
        (("--topic", "/joy"), "joystick: value /joy: --topic with one of /console/joy"),
        (("--axes", "wheel"), "--axes: value 'wheel'"),
        (("--buttons", "wheel"), "--buttons: value 'wheel'"),
    ):
        assert run(*words, *wrong) == 2
        assert said in capsys.readouterr().err
    assert run("import", short, "--out", tmp_path / "t.csv") == 2
    assert "not a bag: it holds no metadata.yaml" in capsys.readouterr().err
