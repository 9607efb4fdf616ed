import json
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

from simconsole.recording.bundles.bundle import BundleWriter, open_bundle
from simconsole.recording.bundles.manifest import (
    ROOM_BYTES,
    Manifest,
    checksum_problem,
    file_entry,
    read_manifest,
    size_problem,
    write_manifest,
)
from simconsole.recording.log_header import LogHeader
from simconsole.values.errors import RecordingError
from tests.manifests import content_of, forge
from tests.paths import ROOT


@pytest.mark.parametrize(
    "name", ["../x.yaml", "/etc/x", "a/b", "manifest.json", "signature.json", "", "..", "a\0b", "c:x", "a\\b"]
)
def test_names_that_leave_the_folder_are_refused(tmp_path: Path, header: LogHeader, name: str, bundle: Path) -> None:
    with pytest.raises(RecordingError, match="not a plain file name"):
        BundleWriter(tmp_path / "other", header, {name: ""})
    forge(bundle, lambda manifest: manifest["files"].update({name: manifest["files"]["drive.log"]}))
    with pytest.raises(RecordingError, match="not a plain file name"):
        open_bundle(bundle)


@pytest.mark.parametrize(
    ("content", "named"),
    [
        ("", "truncated"),
        ("{", "truncated"),
        ("[]", "Expected `object`"),
        ('{"schema": 3, "new": 1}', "schema: 3 cannot be read, this simconsole reads 1 to 2"),
        ('{"schema": 2}', "altered: its second line is not its own sha256"),
        ('{"schema": 1, "sha256": ""}', "sha256"),
        ('{"schema": 1, "extra": 1}', "extra"),
        ('{"schema": 1, "ticks": "many"}', "ticks"),
        ("[" * 100_000, ""),
        (" " * (1 << 21), "allowed up to"),
    ],
)
def test_a_bad_manifest_is_one_line(bundle: Path, content: str, named: str) -> None:
    (bundle / "manifest.json").write_text(content)
    with pytest.raises(RecordingError) as caught:
        open_bundle(bundle)
    assert str(caught.value).startswith(f"{bundle / 'manifest.json'}: ")
    assert named in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_folder_that_is_no_bundle(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"manifest\.json: not a bundle: No such file"):
        open_bundle(tmp_path)


def test_a_manifest_is_read_as_it_was_written(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_bytes(b"abc")
    entry = file_entry(tmp_path / "a.txt")
    wanted = Manifest(finished=True, files={"a.txt": entry}, ticks=7, digest="ff", summary={"late_us": 1.5})
    write_manifest(tmp_path, wanted)
    assert read_manifest(tmp_path) == wanted
    assert entry.sha256 == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"  # FIPS 180-4, of abc
    assert [path.name for path in tmp_path.iterdir() if path.name.startswith("manifest")] == ["manifest.json"]


def test_a_file_of_another_size_or_content_is_told_in_words(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_bytes(b"abc")
    entry = file_entry(path)
    assert (size_problem(path, entry), checksum_problem(path, entry)) == (None, None)
    path.write_bytes(b"abd")
    assert size_problem(path, entry) is None
    assert str(checksum_problem(path, entry)).startswith(f"{path}: altered, sha256 ")
    path.write_bytes(b"ab")
    assert size_problem(path, entry) == f"{path}: truncated, 2 of 3 bytes"
    path.write_bytes(b"abcd")
    assert size_problem(path, entry) == f"{path}: 4 bytes, manifest.json says 3"
    path.unlink()
    assert "cannot be read: No such file" in str(checksum_problem(path, entry))


def test_a_failure_is_written_though_its_summary_has_no_room(tmp_path: Path) -> None:
    """Only so much is kept free on a disk that may have filled up."""
    huge = {"figures": list(range(20_000))}
    write_manifest(tmp_path, Manifest(summary=huge))
    assert read_manifest(tmp_path).summary == huge
    write_manifest(tmp_path, Manifest(summary=huge, recording_failure="no space left"))
    assert (tmp_path / "manifest.json").stat().st_size <= ROOM_BYTES
    found = read_manifest(tmp_path)
    assert (found.summary, found.recording_failure) == ({}, "no space left")


def test_every_other_byte_in_a_manifest_is_refused_in_one_line(bundle: Path) -> None:
    """Changed, added or removed, in every place: whitespace, the summary and its own checksum included."""
    path = bundle / "manifest.json"
    content = path.read_bytes()
    assert b"late_p99_us" in content
    for at in range(len(content) + 1):
        wrong = [content[:at] + bytes([byte]) + content[at:] for byte in b" \n0,"]
        if at < len(content):
            wrong += [content[:at] + content[at + 1 :], content[:at] + bytes([content[at] ^ 1]) + content[at + 1 :]]
            wrong.append(content[:at] + bytes([content[at] ^ 0x20]) + content[at + 1 :])  # the other case of a letter
        for text in wrong:
            path.write_bytes(text)
            with pytest.raises(RecordingError) as caught:
                read_manifest(bundle)
            assert str(caught.value).startswith(f"{path}: ")
            assert "\n" not in str(caught.value)


def test_a_manifest_of_schema_1_is_read_and_does_not_vouch_for_itself(bundle: Path) -> None:
    now = read_manifest(bundle)
    assert now.vouches_for_itself
    content = content_of(bundle)
    del content["provenance"]
    (bundle / "manifest.json").write_text(json.dumps({**content, "schema": 1, "labels": {}}, indent=2))
    before = read_manifest(bundle)
    assert not before.vouches_for_itself
    assert (before.files, before.digest, before.summary) == (now.files, now.digest, now.summary)
    write_manifest(bundle, before)
    assert read_manifest(bundle).vouches_for_itself


def test_a_signed_bundle_takes_no_other_manifest(bundle: Path) -> None:
    (bundle / "signature.json").write_text("{}")
    before = (bundle / "manifest.json").read_bytes()
    with pytest.raises(RecordingError, match=rf"signed, .* simconsole sign {bundle} --remove$"):
        write_manifest(bundle, Manifest())
    assert (bundle / "manifest.json").read_bytes() == before


def test_a_manifest_keeps_to_its_published_schema(bundle: Path, short: Path) -> None:
    schema = json.loads((ROOT / "docs" / "schemas" / "manifest.schema.json").read_text())
    for folder in (bundle, short):
        manifest = json.loads((folder / "manifest.json").read_text())
        assert Draft202012Validator(schema).is_valid(manifest)
        assert not Draft202012Validator(schema).is_valid(manifest | {"files": []})
        assert not Draft202012Validator(schema).is_valid(manifest | {"invented": 1})
        assert not Draft202012Validator(schema).is_valid(manifest | {"sha256": "short"})
