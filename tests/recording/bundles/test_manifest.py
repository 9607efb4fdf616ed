import json
from pathlib import Path

import pytest

from simconsole.recording.bundles.bundle import BundleWriter, open_bundle
from simconsole.recording.framing import LogHeader
from simconsole.values.errors import RecordingError


@pytest.mark.parametrize("name", ["../x.yaml", "/etc/x", "a/b", "manifest.json", "", "..", "a\0b", "c:x", "a\\b"])
def test_names_that_leave_the_folder_are_refused(tmp_path: Path, header: LogHeader, name: str, bundle: Path) -> None:
    with pytest.raises(RecordingError, match="not a plain file name"):
        BundleWriter(tmp_path / "other", header, {name: ""})
    raw = json.loads((bundle / "manifest.json").read_text())
    raw["files"][name] = raw["files"]["drive.log"]
    (bundle / "manifest.json").write_text(json.dumps(raw))
    with pytest.raises(RecordingError, match="not a plain file name"):
        open_bundle(bundle)


@pytest.mark.parametrize(
    ("content", "named"),
    [
        ("", "truncated"),
        ("{", "truncated"),
        ("[]", "Expected `object`"),
        ('{"schema": 2, "new": 1}', "schema: 2 cannot be read, this simconsole reads 1 to 1"),
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
