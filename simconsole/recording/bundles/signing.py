"""A signature over a bundle's manifest, and so over every byte of its files: Ed25519 (RFC 8032), in signature.json.

What is signed are the bytes of manifest.json, followed by the signer's name and the time, a line each. The file names
the public key, but a key proves nothing by lying beside what it has signed: whoever changes a bundle can sign it again
with a key of his own. Only a public key that came another way tells.
"""

import base64
import binascii
import os
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal

import msgspec

from simconsole.recording.bundles.manifest import MANIFEST, SIGNATURE, read_bounded, refuse_signed
from simconsole.recording.bundles.provenance import ID_CHARS, utc_now
from simconsole.recording.bundles.sealing import KEY, read_object, seal_problem, sealed
from simconsole.values.errors import RecordingError
from simconsole.values.host.files import write_atomically

if TYPE_CHECKING:
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey, Ed25519PublicKey

PUBLIC: Final = ".pub"
"""Suffix of the public key's file, beside that of the private key."""


class Signature(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """signature.json, to which sealing.py adds its own checksum."""

    schema: Literal[1] = 1
    """Version of the signature's file; always 1."""
    algorithm: Literal["Ed25519"] = "Ed25519"
    """How the signature is made."""
    public_key: str
    """The public key, its 32 bytes in base64."""
    signature: str
    """The signature, its 64 bytes in base64."""
    signer: str = ""
    """Who signed, as they called themselves."""
    signed_utc: str
    """When it was signed, ISO 8601, by the machine's clock."""


def make_key(path: Path) -> str:
    """Write a new private key, which only its owner may read, and the public key beside it; return the public one.

    Raises:
        RecordingError: one of the files exists, or cannot be written.
    """
    from cryptography.hazmat.primitives import serialization as form
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

    key = Ed25519PrivateKey.generate()
    private = key.private_bytes(form.Encoding.PEM, form.PrivateFormat.PKCS8, form.NoEncryption())
    public = key.public_key().public_bytes(form.Encoding.PEM, form.PublicFormat.SubjectPublicKeyInfo)
    beside = path.with_name(path.name + PUBLIC)
    if beside.exists():
        raise RecordingError(f"{beside}: exists; another file for the new key")
    _write_new(path, private, 0o600)
    _write_new(beside, public, 0o644)
    return _text(key.public_key().public_bytes_raw())


def sign(folder: Path, key: Path, signer: str = "") -> Signature:
    """Sign the manifest of a bundle, which the caller has verified.

    Args:
        folder: of the bundle.
        key: file of the private key, PEM, without a password.
        signer: who signs, for people; only the key proves it.

    Raises:
        RecordingError: signed already, no such key, a name that is too long, or the signature cannot be written.
    """
    refuse_signed(folder)
    if len(signer) > ID_CHARS or not signer.isprintable():
        raise RecordingError(f"signer: value {signer[:ID_CHARS]!r}: up to {ID_CHARS} printable characters")
    private = _private_key(key)
    content, now = read_bounded(folder / MANIFEST), utc_now()
    signature = Signature(
        public_key=_text(private.public_key().public_bytes_raw()),
        signature=_text(private.sign(_message(content, signer, now))),
        signer=signer,
        signed_utc=now,
    )
    try:
        write_atomically(folder / SIGNATURE, sealed(signature))
    except OSError as error:
        raise RecordingError(f"{folder / SIGNATURE}: cannot be written: {error.strerror}") from None
    return signature


def remove_signature(folder: Path) -> None:
    """Take the signature off a bundle, so that it may be changed again.

    Raises:
        RecordingError: there is none, or it cannot be removed.
    """
    try:
        (folder / SIGNATURE).unlink()
    except OSError as error:
        raise RecordingError(f"{folder / SIGNATURE}: cannot be removed: {error.strerror}") from None


def signature_problem(folder: Path, manifest: bytes, signer: Path | None) -> str | None:
    """Return one line if the signature is not one of these bytes of the manifest, or not that key's; else None.

    Raises:
        RecordingError: `signer` is no public key.
    """
    from cryptography.exceptions import InvalidSignature
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PublicKey

    path = folder / SIGNATURE
    wanted = None if signer is None else _public_key(signer).public_bytes_raw()
    if not path.exists():
        return f"{path}: not signed by {signer}: there is no signature"
    try:
        signature = _read(path)
        key = base64.b64decode(signature.public_key, validate=True)
        if wanted is not None and key != wanted:
            return f"{path}: not signed by {signer}, but with the key {signature.public_key}"
        seal = base64.b64decode(signature.signature, validate=True)
        Ed25519PublicKey.from_public_bytes(key).verify(seal, _message(manifest, signature.signer, signature.signed_utc))
    except RecordingError as error:
        return str(error)
    except (ValueError, binascii.Error) as error:
        return f"{path}: {error}"
    except InvalidSignature:
        return f"{path}: the signature is not that of {MANIFEST}: one of the two was changed"
    return None


def signed_by(folder: Path, signer: Path | None) -> str:
    """Return one line for people on a signature that is good.

    Raises:
        RecordingError: it is not there any more.
    """
    found = _read(folder / SIGNATURE)
    said = f"{folder / SIGNATURE}: signed {found.signed_utc}{f' by {found.signer}' if found.signer else ''}"
    if signer is not None:
        return f"{said} with the key of {signer}"
    return f"{said} with the key {found.public_key}: whether that is a key to trust, --signer FILE.pub tells"


def _read(path: Path) -> Signature:
    content = read_bounded(path)
    raw = read_object(path, content)
    if problem := seal_problem(path, content):
        raise RecordingError(problem)
    del raw[KEY]
    try:
        return msgspec.convert(raw, Signature)
    except msgspec.ValidationError as error:
        raise RecordingError(f"{path}: {error}") from None


def _message(manifest: bytes, signer: str, signed_utc: str) -> bytes:
    return manifest + f"{signer}\n{signed_utc}\n".encode()


def _text(content: bytes) -> str:
    return base64.b64encode(content).decode()


def _private_key(path: Path) -> "Ed25519PrivateKey":
    from cryptography.exceptions import UnsupportedAlgorithm
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey
    from cryptography.hazmat.primitives.serialization import load_pem_private_key

    try:
        key = load_pem_private_key(_key_text(path), None)
    except TypeError:
        raise RecordingError(f"{path}: has a password; simconsole signs with keys that have none") from None
    except (ValueError, UnsupportedAlgorithm):
        raise RecordingError(f"{path}: no private key in PEM; simconsole sign --new-key FILE makes one") from None
    if not isinstance(key, Ed25519PrivateKey):
        raise RecordingError(f"{path}: another kind of key; simconsole sign --new-key FILE makes one of Ed25519")
    return key


def _public_key(path: Path) -> "Ed25519PublicKey":
    from cryptography.exceptions import UnsupportedAlgorithm
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PublicKey
    from cryptography.hazmat.primitives.serialization import load_pem_public_key

    try:
        key = load_pem_public_key(_key_text(path))
    except (ValueError, UnsupportedAlgorithm):
        raise RecordingError(f"{path}: no public key in PEM, as simconsole sign --new-key writes beside it") from None
    if not isinstance(key, Ed25519PublicKey):
        raise RecordingError(f"{path}: another kind of key: Ed25519")
    return key


def _key_text(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise RecordingError(f"{path}: cannot be read: {error.strerror}") from None


def _write_new(path: Path, content: bytes, mode: int) -> None:
    try:
        descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, mode)
        with os.fdopen(descriptor, "wb") as file:
            file.write(content)
    except OSError as error:
        raise RecordingError(f"{path}: cannot be written: {error.strerror}") from None
