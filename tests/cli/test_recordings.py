"""What can be done with a bundle, from the command line."""

import os
import shutil
import signal
from collections.abc import Callable
from pathlib import Path

import pytest

from simconsole.cli.main import main
from tests.drives.console import Running, complaint, results, simconsole, within
from tests.patience import wait_until

FORGED_TICK = 400


@pytest.fixture
def copy(short: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(short, tmp_path / "copy"))


ALL_EQUAL = {
    "equal": True,
    "ticks": 750,
    "differences": [],
    "messages": [],
    "only_first": [],
    "only_second": [],
    "reason": "",
    "problems": [],
}


def test_verify_says_that_a_bundle_is_whole_or_what_is_wrong(short: Path, tmp_path: Path) -> None:
    done = simconsole("verify", short)
    assert done.returncode == 0
    assert done.stdout == f"{short}: whole\n"
    spoilt = Path(shutil.copytree(short, tmp_path / "spoilt"))
    content = bytearray((spoilt / "drive.log").read_bytes())
    content[-2000] ^= 1
    (spoilt / "drive.log").write_bytes(content)
    done = within("verify", spoilt, "--json")
    assert done.returncode == 1
    found = results(done)
    assert not found["good"]
    assert all(str(spoilt / "drive.log") in problem for problem in found["problems"])


def test_compare_finds_a_bundle_equal_to_itself(short: Path) -> None:
    done = within("compare", short, short, "--json")
    assert done.returncode == 0
    assert results(done) == ALL_EQUAL


def test_report_is_written_again(short: Path, tmp_path: Path) -> None:
    short = Path(shutil.copytree(short, tmp_path / "copy"))
    (short / "report.html").unlink()
    done = within("report", short, "--json")
    assert done.returncode == 0, done.stderr
    assert results(done)["duration_s"] == 3.0
    assert str(short / "report.html") in done.stderr
    assert (short / "report.html").read_text("utf-8").startswith("<!DOCTYPE html>")
    assert within("verify", short).returncode == 0


def test_view_writes_the_scene_without_opening_it(short: Path, tmp_path: Path) -> None:
    short = Path(shutil.copytree(short, tmp_path / "copy"))
    (short / "scene.rrd").unlink()
    done = within("view", short, "--no-open", "--json")
    assert done.returncode == 0, done.stderr
    assert results(done) == {"scene": str(short / "scene.rrd"), "problems": []}
    assert (short / "scene.rrd").read_bytes()[:4] == b"RRF2"


def test_view_opens_a_bundle_s_scene_in_a_window_that_listens_on_this_machine_only(
    short: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The scene that is opened is the one that was written before."""
    opened: list[str] = []
    monkeypatch.setattr("simconsole.scene.viewer.scene_server.open_native", opened.append)
    monkeypatch.setattr("simconsole.evaluation.report.exports.write_scene", lambda folder, told: folder / "scene.rrd")
    assert main(["view", str(short)]) == 0
    assert opened == [str(short / "scene.rrd")]


def test_view_shows_a_bundle_in_the_browser_when_told_so(short: Path, tmp_path: Path) -> None:
    """BROWSER names a program that is started instead of the browser: a client of the served scene."""
    seen = tmp_path / "address"
    browser = tmp_path / "browser"
    browser.write_text(f'#!/bin/sh\necho "$1" > {seen}.new\nmv {seen}.new {seen}\n')
    browser.chmod(0o755)
    with Running(tmp_path / "view", "view", short, "--browser", "--json", BROWSER=str(browser)) as shown:
        wait_until(lambda: shown.process.poll() is not None or seen.exists(), "a browser")
        assert seen.read_text().startswith("http://127.0.0.1:")
        wait_until(lambda: shown.said("browsers of this machine"), "the address")
        os.kill(shown.process.pid, signal.SIGINT)
        done = shown.end()
    assert done.returncode == 130, done.stderr
    assert results(done)["scene"] == str(short / "scene.rrd")
    assert "the drive has ended" not in done.stderr


def test_compare_finds_two_drives_of_one_script_equal(script: Path, plain: Path, tmp_path: Path) -> None:
    """One in this process and one in a program of its own."""
    first, again = tmp_path / "first", tmp_path / "again"
    words = ("drive", plain, "--driver", f"script:{script}", "--for", 3)
    done = within(*words, "--out", first, "--no-pack")
    assert done.returncode == 0, done.stderr
    done = simconsole(*words, "--out", again, "--json")
    assert done.returncode == 0, done.stderr
    assert results(done)["packing_failure"] is None
    compared = within("compare", first, again, "--json")
    assert compared.returncode == 0, compared.stderr
    assert results(compared) == ALL_EQUAL
    assert not (again / "drive.log").exists()
    assert within("unpack", again).returncode == 0
    assert (first / "drive.log").read_bytes() == (again / "drive.log").read_bytes()


def test_a_packed_bundle_serves_every_command(copy: Path) -> None:
    log = (copy / "drive.log").read_bytes()
    done = simconsole("pack", copy, "--json")
    sizes = {"log_bytes": len(log), "packed_bytes": (copy / "drive.parquet").stat().st_size}
    assert results(done) == {"bundles": {str(copy): sizes}, "failures": {}}
    assert done.returncode == 0
    assert len(done.stderr.splitlines()) == 1  # what came of it; progress is for terminals
    assert sorted(path.name for path in copy.iterdir()) == [
        *("drive.parquet", "manifest.json", "report.html", "scene.rrd", "session.json")
    ]
    for words in (["verify"], ["replay"], ["report"], ["view", "--no-open"], ["verify"]):
        done = within(*words, copy)
        assert done.returncode == 0, (words, done.stdout, done.stderr)
    assert within("unpack", copy).returncode == 0
    assert (copy / "drive.log").read_bytes() == log


def test_what_cannot_be_packed_is_named_and_the_others_are_packed(copy: Path, tmp_path: Path) -> None:
    done = within("pack", tmp_path / "nowhere", copy, "--json")
    assert done.returncode == 2
    assert list(results(done)["failures"]) == [str(tmp_path / "nowhere")]
    assert "nowhere/manifest.json: not a bundle" in done.stderr
    assert (copy / "drive.parquet").exists()


@pytest.fixture
def forged(copy: Path, rewrite_log: Callable[..., None], rewrite_checksums: Callable[[Path], None]) -> Path:
    """A bundle with one value changed, all hashes right."""
    rewrite_log(copy / "drive.log", FORGED_TICK, "vehicle.vx_mps", 7.25)
    rewrite_checksums(copy)
    return copy


def test_compare_names_every_field_that_differs_with_the_ticks_around(short: Path, forged: Path) -> None:
    done = within("compare", short, forged, "--json")
    assert done.returncode == 1
    found = results(done)
    (difference,) = found["differences"]
    assert (found["equal"], found["ticks"]) == (False, 750)
    assert (difference["field"], difference["unit"]) == ("vehicle.vx_mps", "m/s")
    assert (difference["first_tick"], difference["ticks"], difference["second"]) == (FORGED_TICK, 1, 7.25)
    assert [around["tick"] for around in difference["around"]] == list(range(FORGED_TICK - 3, FORGED_TICK + 4))
    assert "750 ticks compared, 1 fields differ" in done.stderr
    assert f">{FORGED_TICK}" in done.stderr
    assert "7.25" in done.stderr


@pytest.fixture
def key(tmp_path: Path) -> Path:
    made = within("sign", "--new-key", tmp_path / "lab.pem", "--json")
    assert made.returncode == 0, made.stderr
    assert results(made)["public_key"] in made.stderr.splitlines()[0]
    return tmp_path / "lab.pem"


def test_a_bundle_is_signed_checked_and_changed_only_without_its_signature(copy: Path, key: Path) -> None:
    assert within("verify", copy, "--signer", f"{key}.pub").returncode == 1, "not signed yet"
    done = within("sign", copy, "--key", key, "--name", "Lab 2", "--json")
    assert done.returncode == 0, done.stderr
    checked = within("verify", copy, "--signer", f"{key}.pub")
    assert checked.returncode == 0, checked.stdout
    assert checked.stdout.splitlines()[0] == f"{copy}: whole"
    assert f"by Lab 2 with the key of {key}.pub" in checked.stdout
    assert results(within("verify", copy, "--json"))["good"]
    for command in ("report", "sign"):
        refused = complaint(within(command, copy, *(["--key", key] if command == "sign" else [])))
        assert f"take the signature away first: simconsole sign {copy} --remove" in refused
    assert within("view", copy, "--no-open").stdout == f"{copy / 'scene.rrd'}\n", "the one that was signed"
    assert within("replay", copy).returncode == 0
    assert within("verify", copy, "--signer", f"{key}.pub").returncode == 0
    assert within("sign", copy, "--remove").returncode == 0
    assert within("report", copy).returncode == 0
    assert within("verify", copy).returncode == 0


def test_only_a_whole_bundle_is_signed(copy: Path, key: Path) -> None:
    (copy / "notes.txt").write_text("not the drive's")
    done = within("sign", copy, "--key", key)
    assert done.returncode == 1
    assert done.stdout.splitlines() == [
        f"{copy}: not signed, for it is not whole",
        f"{copy / 'notes.txt'}: not in manifest.json: nothing vouches for it",
    ]
    assert not (copy / "signature.json").exists()


def test_sign_says_what_it_needs(copy: Path, key: Path) -> None:
    for words in ((), (copy,), ("--key", key), (copy, "--key", key, "--remove"), (copy, "--new-key", key)):
        assert "command line: BUNDLE --key FILE, BUNDLE --remove, or --new-key" in complaint(within("sign", *words))
    assert "exists; another file for the new key" in complaint(within("sign", "--new-key", key))
    assert "lab.pem.pub: no private key in PEM" in complaint(within("sign", copy, "--key", f"{key}.pub"))


def test_a_changed_manifest_is_one_line_to_every_command(copy: Path) -> None:
    path = copy / "manifest.json"
    path.write_bytes(path.read_bytes().replace(b'"lateness": "not paced"', b'"lateness": "all paced"'))
    for command in ("verify", "replay", "report"):
        assert f"{path}: altered: sha256 " in complaint(within(command, copy))


@pytest.mark.parametrize("command", ["compare", "replay"])
@pytest.mark.parametrize(
    ("text", "code"),
    [("vehicle.vx_mps: 100\n", 0), ('{"vehicle.*": "ignore"}', 0), ("vehicle.vx_mps: 0.001\n", 1)],
)
def test_tolerances_are_read_from_a_file(
    short: Path, forged: Path, tmp_path: Path, command: str, text: str, code: int
) -> None:
    (tmp_path / "tolerances.yaml").write_text(text)
    bundles = (short, forged) if command == "compare" else (forged,)
    done = within(command, *bundles, "--tolerances", tmp_path / "tolerances.yaml", "--json")
    assert done.returncode == code, done.stdout + done.stderr
    assert results(done)["equal"] is (code == 0)
    assert "every hash equal" not in done.stderr
    assert command == "compare" or code or "no field of both differs by more than its tolerance" in done.stderr


def test_a_tolerance_for_no_field_is_one_line(short: Path, tmp_path: Path) -> None:
    (tmp_path / "tolerances.yaml").write_text("vehicle.speed_kmh: 1\n")
    assert "vehicle.speed_kmh" in complaint(within("replay", short, "--tolerances", tmp_path / "tolerances.yaml"))
