import json
import stat
from base64 import b64decode
from pathlib import Path

import pytest
from cryptography.hazmat.primitives import serialization as form
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey, Ed25519PublicKey
from jsonschema import Draft202012Validator

from simconsole.recording.bundles.bundle import add_export
from simconsole.recording.bundles.sealing import sealed
from simconsole.recording.bundles.signing import make_key, remove_signature, sign, signature_problem, signed_by
from simconsole.values.errors import RecordingError
from tests.paths import ROOT


@pytest.fixture
def key(tmp_path: Path) -> Path:
    make_key(tmp_path / "lab.pem")
    return tmp_path / "lab.pem"


def problem(bundle: Path, signer: Path | None = None) -> str | None:
    return signature_problem(bundle, (bundle / "manifest.json").read_bytes(), signer)


def rewrite(bundle: Path, **changes: object) -> None:
    """Change fields of a signature, and make its own checksum right again."""
    content = json.loads((bundle / "signature.json").read_text())
    del content["sha256"]
    (bundle / "signature.json").write_bytes(sealed({**content, **changes}))


def test_only_its_owner_may_read_a_new_key_and_none_is_written_over(key: Path) -> None:
    assert stat.S_IMODE(key.stat().st_mode) == 0o600
    before = key.read_bytes()
    with pytest.raises(RecordingError, match=r"lab\.pem\.pub: exists"):
        make_key(key)
    key.with_name("lab.pem.pub").unlink()
    with pytest.raises(RecordingError, match=r"lab\.pem: cannot be written: File exists"):
        make_key(key)
    assert key.read_bytes() == before
    with pytest.raises(RecordingError, match="cannot be written: No such file"):
        make_key(key.parent / "nowhere" / "key")


def test_a_signature_is_one_of_the_manifests_bytes_the_name_and_the_time(bundle: Path, key: Path) -> None:
    """Checked with nothing of ours but the file."""
    made = sign(bundle, key, "Ünal, Lab 2")
    public = form.load_pem_public_key(key.with_name("lab.pem.pub").read_bytes())
    assert isinstance(public, Ed25519PublicKey)
    content = json.loads((bundle / "signature.json").read_text())
    assert b64decode(content["public_key"]) == public.public_bytes_raw()
    assert (content["algorithm"], content["signer"], content["signed_utc"]) == (
        "Ed25519",
        "Ünal, Lab 2",
        made.signed_utc,
    )
    message = (bundle / "manifest.json").read_bytes() + f"Ünal, Lab 2\n{made.signed_utc}\n".encode()
    public.verify(b64decode(content["signature"]), message)
    assert problem(bundle) is None
    assert problem(bundle, key.with_name("lab.pem.pub")) is None
    assert "by Ünal, Lab 2 with the key of " in signed_by(bundle, key.with_name("lab.pem.pub"))
    assert "--signer FILE.pub tells" in signed_by(bundle, None)


@pytest.mark.parametrize("change", [{"signer": "Nobody"}, {"signed_utc": "2001-01-01T00:00:00+00:00"}])
def test_who_and_when_are_signed_too(bundle: Path, key: Path, change: dict[str, str]) -> None:
    sign(bundle, key, "Somebody")
    rewrite(bundle, **change)
    assert "the signature is not that of manifest.json" in str(problem(bundle))


@pytest.mark.parametrize(
    ("change", "named"),
    [
        ({"schema": 2}, "schema"),
        ({"algorithm": "none"}, "algorithm"),
        ({"public_key": "AAAA"}, "An Ed25519 public key is 32 bytes long"),
        ({"public_key": "%"}, "base64"),
        ({"signature": "é"}, "ASCII"),
        ({"signature": ""}, "the signature is not that"),
        ({"invented": 1}, "invented"),
    ],
)
def test_a_signature_that_is_none_is_one_line(bundle: Path, key: Path, change: dict[str, object], named: str) -> None:
    sign(bundle, key)
    rewrite(bundle, **change)
    said = str(problem(bundle))
    assert said.startswith(f"{bundle / 'signature.json'}: ")
    assert named in said
    assert "\n" not in said


def test_a_signed_bundle_changes_only_once_its_signature_is_gone(bundle: Path, key: Path) -> None:
    sign(bundle, key)
    (bundle / "report.html").write_text("<html>")
    with pytest.raises(RecordingError, match="signed, so nothing of this bundle may change"):
        add_export(bundle, "report.html")
    with pytest.raises(RecordingError, match=r"take the signature away first: simconsole sign .* --remove"):
        sign(bundle, key)
    remove_signature(bundle)
    add_export(bundle, "report.html")
    sign(bundle, key)
    assert problem(bundle) is None
    remove_signature(bundle)
    with pytest.raises(RecordingError, match=r"signature\.json: cannot be removed: No such file"):
        remove_signature(bundle)


def test_keys_that_cannot_sign_or_check_are_one_line(bundle: Path, key: Path, tmp_path: Path) -> None:
    pem, private = form.Encoding.PEM, form.PrivateFormat.PKCS8
    other = ec.generate_private_key(ec.SECP256R1())
    (tmp_path / "ec").write_bytes(other.private_bytes(pem, private, form.NoEncryption()))
    (tmp_path / "ec.pub").write_bytes(other.public_key().public_bytes(pem, form.PublicFormat.SubjectPublicKeyInfo))
    locked = Ed25519PrivateKey.generate().private_bytes(pem, private, form.BestAvailableEncryption(b"word"))
    (tmp_path / "locked").write_bytes(locked)
    (tmp_path / "text").write_text("key")
    for name, said in (
        ("ec", "another kind of key"),
        ("locked", "has a password"),
        ("text", "no private key in PEM"),
        ("lab.pem.pub", "no private key in PEM"),
        ("none", "cannot be read: No such file"),
    ):
        with pytest.raises(RecordingError, match=said):
            sign(bundle, tmp_path / name)
        assert not (bundle / "signature.json").exists()
    sign(bundle, key)
    for name, said in (
        ("ec.pub", "another kind of key"),
        ("lab.pem", "no public key in PEM"),
        ("none", "cannot be read: No such file"),
    ):
        with pytest.raises(RecordingError, match=said):
            problem(bundle, tmp_path / name)


def test_a_name_too_long_or_with_line_breaks_signs_nothing(bundle: Path, key: Path) -> None:
    for name in ("x" * 65, "two\nlines"):
        with pytest.raises(RecordingError, match=r"signer: value .* up to 64 printable characters"):
            sign(bundle, key, name)
    assert not (bundle / "signature.json").exists()


def test_a_signature_keeps_to_its_published_schema(bundle: Path, key: Path) -> None:
    schema = json.loads((ROOT / "docs" / "schemas" / "signature.schema.json").read_text())
    sign(bundle, key)
    content = json.loads((bundle / "signature.json").read_text())
    assert Draft202012Validator(schema).is_valid(content)
    assert not Draft202012Validator(schema).is_valid(content | {"algorithm": "none"})
    assert not Draft202012Validator(schema).is_valid(
        {name: value for name, value in content.items() if name != "signature"}
    )
