"""Every byte of every file of a bundle is vouched for, and what nothing vouches for is named."""

import json
import random
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from simconsole.recording.bundles.bundle import BundleWriter, add_export, unlisted
from simconsole.recording.bundles.manifest import read_manifest
from simconsole.recording.bundles.pack import pack
from simconsole.recording.bundles.signing import make_key, sign
from simconsole.recording.bundles.verification import coverage, examine, verify
from simconsole.recording.log_header import LogHeader
from simconsole.values.errors import RecordingError
from tests.manifests import content_of, forge
from tests.recording.conftest import TEXTS
from tests.samples import Sample


def signed(folder: Path, keys: Path) -> Path:
    make_key(keys / "key")
    sign(folder, keys / "key", "The Lab")
    return folder


def changed(content: bytes, chance: random.Random) -> bytes:
    """Change, add or remove one byte."""
    at = chance.randrange(len(content))
    kind = chance.randrange(3)
    if kind == 0:
        return content[:at] + bytes([content[at] ^ chance.randrange(1, 256)]) + content[at + 1 :]
    if kind == 1:
        return content[:at] + bytes([chance.randrange(256)]) + content[at:]
    return content[:at] + content[at + 1 :]


def refused(folder: Path) -> bool:
    try:
        return bool(verify(folder))
    except RecordingError as error:
        return "\n" not in str(error)


@pytest.mark.parametrize("log", ["drive.log", "drive.parquet"])
def test_no_changed_byte_of_any_file_passes(short: Path, tmp_path: Path, sample: Sample, log: str) -> None:
    """Of log, session, report, scene, manifest and signature alike, however short the file is; packed or not."""
    bundle = Path(shutil.copytree(short, tmp_path / "bundle"))
    if log == "drive.parquet":
        pack(bundle)
    signed(bundle, tmp_path)
    names = sorted(path.name for path in bundle.iterdir())
    assert names == [log, "manifest.json", "report.html", "scene.rrd", "session.json", "signature.json"]
    assert verify(bundle) == []
    chance, times = random.Random(sample.seed), sample.of(48, 2_000)
    for turn in range(times):
        path = bundle / names[turn % len(names)]
        content = path.read_bytes()
        other = changed(content, chance)
        path.write_bytes(other)
        assert refused(bundle), f"{path.name}, turn {turn}"
        path.write_bytes(content)
    assert verify(bundle) == []


def test_no_changed_byte_of_a_drive_that_was_killed_goes_unnoticed(
    tmp_path: Path, header: LogHeader, rows: list[np.ndarray]
) -> None:
    """Its log has no checksum in the manifest yet: its header and ticks have their own."""
    with BundleWriter(tmp_path / "b", header, TEXTS) as writer:
        for tick, row in enumerate(rows, start=1):
            writer.log.append(tick, row)
        shutil.copytree(tmp_path / "b", tmp_path / "killed")
    as_left = verify(tmp_path / "killed")
    assert as_left == [f"{tmp_path / 'killed' / 'manifest.json'}: the drive was not finished"]
    chance = random.Random(1)
    for name in ("drive.log", "manifest.json", "session.yaml", "vehicle.yaml"):
        path = tmp_path / "killed" / name
        content = path.read_bytes()
        for _ in range(200):
            at = chance.randrange(len(content))
            path.write_bytes(content[:at] + bytes([content[at] ^ 1 << chance.randrange(8)]) + content[at + 1 :])
            try:
                assert verify(path.parent) != as_left, (name, at)
            except RecordingError:
                continue
        path.write_bytes(content)


def test_what_nobody_listed_is_named(bundle: Path) -> None:
    (bundle / "answers.csv").write_text("1")
    (bundle / "folder").mkdir()
    (bundle / "report.html.new").write_text("")
    names = ("answers.csv", "folder", "report.html.new")
    assert verify(bundle) == [f"{bundle / name}: not in manifest.json: nothing vouches for it" for name in names]
    assert unlisted(bundle, read_manifest(bundle)) == list(names)
    assert [part for name in names for part in coverage(bundle).others if part == name] == list(names)


def test_what_a_killed_drive_leaves_beside_its_log_is_no_more_than_a_remark(tmp_path: Path, header: LogHeader) -> None:
    with BundleWriter(tmp_path / "b", header, TEXTS):
        (tmp_path / "b" / "can.blf").write_bytes(b"what the worker had written")
        assert (tmp_path / "b" / "manifest.json.new").exists(), "the room for its end"
        found = examine(tmp_path / "b")
    assert found.problems == [f"{tmp_path / 'b' / 'manifest.json'}: the drive was not finished"]
    assert found.remarks == [f"{tmp_path / 'b' / 'can.blf'}: not in manifest.json: nothing vouches for it"]
    assert coverage(tmp_path / "b").replayed == ["drive.log", "session.yaml", "vehicle.yaml"]


def test_replay_vouches_for_the_drive_and_not_for_what_was_made_from_it(bundle: Path) -> None:
    (bundle / "report.html").write_text("<html>")
    add_export(bundle, "report.html")
    assert coverage(bundle).replayed == ["drive.log", "session.yaml", "vehicle.yaml"]
    assert coverage(bundle).others == ["manifest.json", "report.html"]


def as_schema_1(content: dict[str, Any]) -> None:
    del content["provenance"]
    content["schema"] = 1


def test_that_an_old_manifest_does_not_vouch_for_itself_is_remarked(bundle: Path, tmp_path: Path) -> None:
    forge(bundle, as_schema_1)
    (bundle / "manifest.json").write_text(json.dumps(content_of(bundle)))
    found = examine(bundle)
    assert found.problems == []
    (remark,) = found.remarks
    assert remark.startswith(f"{bundle / 'manifest.json'}: schema 1, which does not vouch for itself")
    (remark,) = examine(signed(bundle, tmp_path)).remarks
    assert "signed" in remark, "the signature vouches for all of it"


def test_a_signature_of_another_key_or_of_nobody_is_a_problem(bundle: Path, tmp_path: Path) -> None:
    make_key(tmp_path / "other")
    public = tmp_path / "other.pub"
    assert examine(bundle, public).problems == [
        f"{bundle / 'signature.json'}: not signed by {public}: there is no signature"
    ]
    signed(bundle, tmp_path)
    (problem,) = examine(bundle, public).problems
    assert problem.startswith(f"{bundle / 'signature.json'}: not signed by {public}, but with the key ")
    assert examine(bundle, tmp_path / "key.pub").problems == []


def test_a_forger_who_makes_all_checksums_right_is_found_by_the_signature(
    bundle: Path, tmp_path: Path, rewrite_log: Callable[..., None], rewrite_checksums: Callable[[Path], None]
) -> None:
    signed(bundle, tmp_path)
    rewrite_log(bundle / "drive.log", 12, "driver.brake", 0.25)
    rewrite_checksums(bundle)
    path = bundle / "signature.json"
    assert verify(bundle) == [f"{path}: the signature is not that of manifest.json: one of the two was changed"]
