"""The certificate for a bridge: who it is for, for how long, and who can read its key."""

import datetime
import ipaddress
from pathlib import Path

import pytest
from cryptography import x509
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.hazmat.primitives.serialization import load_pem_private_key

from simconsole.cli.certificate import make, write_private


def names(certificate: x509.Certificate) -> list[str]:
    found = certificate.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    return [str(entry.value) for entry in found]


@pytest.mark.parametrize(
    ("host", "expected"),
    [
        ("rig.lab", ["rig.lab", "localhost", "127.0.0.1", "::1"]),
        ("192.168.7.3", ["192.168.7.3", "localhost", "127.0.0.1", "::1"]),
        ("localhost", ["localhost", "127.0.0.1", "::1"]),
    ],
)
def test_certificate_is_for_the_host_and_for_this_machine(host: str, expected: list[str]) -> None:
    certificate = x509.load_pem_x509_certificate(make(host).certificate)
    assert names(certificate) == expected
    kinds = {type(entry.value) for entry in _general_names(certificate) if str(entry.value) == host}
    assert kinds == {ipaddress.IPv4Address if host[0].isdigit() else str}


def _general_names(certificate: x509.Certificate) -> list[x509.GeneralName]:
    return list(certificate.extensions.get_extension_for_class(x509.SubjectAlternativeName).value)


def test_key_belongs_to_it_and_browsers_accept_its_life() -> None:
    written = make("rig")
    certificate, key = x509.load_pem_x509_certificate(written.certificate), load_pem_private_key(written.key, None)
    assert isinstance(key, ec.EllipticCurvePrivateKey)
    assert key.public_key() == certificate.public_key()
    certificate.verify_directly_issued_by(certificate)
    life = certificate.not_valid_after_utc - certificate.not_valid_before_utc
    assert datetime.timedelta(days=397) <= life < datetime.timedelta(days=398)
    assert certificate.not_valid_after_utc.date().isoformat() == written.until


def test_name_longer_than_a_common_name_may_be_is_whole_among_the_others() -> None:
    host = "a" * 60 + ".example"
    certificate = x509.load_pem_x509_certificate(make(host).certificate)
    assert names(certificate)[0] == host
    assert len(str(certificate.subject.get_attributes_for_oid(x509.NameOID.COMMON_NAME)[0].value)) == 64


def test_file_is_for_its_owner_alone_whatever_stood_there(tmp_path: Path) -> None:
    path, elsewhere = tmp_path / "key", tmp_path / "elsewhere"
    elsewhere.write_bytes(b"other")
    path.symlink_to(elsewhere)
    write_private(path, b"secret")
    assert (path.read_bytes(), elsewhere.read_bytes()) == (b"secret", b"other")
    assert path.stat().st_mode & 0o777 == 0o600
