"""`swarm keys`: an authority of the swarm's own, and what it signs for the world, the recorder, people and agents.

Radios that reach each other directly have an authority of their own: between them both ends are alike, and who is let
in there must not pass for a world.

The authorities' own keys are thrown away: nobody can be added later, whoever finds the folder. For another swarm, or
more agents, all are made anew.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from datetime import UTC, datetime, timedelta
from pathlib import Path

from cryptography import x509
from cryptography.hazmat.primitives import hashes
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.hazmat.primitives.serialization import Encoding, NoEncryption, PrivateFormat
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID

from comms.credentials import AUTHORITY, OPERATOR, RADIO, Credentials, agents_name, agents_named
from comms.keys import RECORDER, WORLD
from missions.problems import InputError

VALID_DAYS = 825
# A computer in the field may wake up with a clock that is behind.
BEFORE_DAYS = 1
_AUTHORITY_NAME = "swarm authority"
Usage = list[x509.ObjectIdentifier]
_BOTH_ENDS: Usage = [ExtendedKeyUsageOID.SERVER_AUTH, ExtendedKeyUsageOID.CLIENT_AUTH]


def issue(folder: Path, *, n_agents: int, per_process: int, force: bool) -> list[str]:
    """Make the credentials of a swarm in `folder`. Returns their names.

    Args:
        per_process: agents that run in one process, and have one name.
        force: put them in place of those that are there.

    Raises:
        InputError: there are some, or the folder cannot be written.
    """
    groups = [range(first, min(first + per_process, n_agents)) for first in range(0, n_agents, per_process)]
    agents = list(map(agents_name, groups))
    names = [WORLD, RECORDER, OPERATOR, *agents]
    radio = folder / RADIO
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        present = sorted(file for where in (folder, radio) for file in where.glob("*") if _is_ours(file))
        if present and not force:
            raise InputError(f"{folder}: holds {present[0].name} already; allowed: another folder, or --force")
        for file in present:
            file.unlink()
        radio.mkdir(mode=0o700, exist_ok=True)
        for path, content in (
            *_files(folder, names, _end_of),
            *_files(radio, [OPERATOR, *agents], lambda name: _BOTH_ENDS),
        ):
            _write(path, content)
    except OSError as error:
        raise InputError(f"{folder}: cannot be written ({error})") from error
    return names


def _is_ours(file: Path) -> bool:
    known = file.name == AUTHORITY or file.stem in (WORLD, RECORDER, OPERATOR) or bool(agents_named(file.stem))
    return known and file.suffix in (".pem", ".key")


def _end_of(name: str) -> Usage:
    """Two kinds: an agent's certificate does not make a world, whatever it says."""
    return [ExtendedKeyUsageOID.SERVER_AUTH if name == WORLD else ExtendedKeyUsageOID.CLIENT_AUTH]


def _files(folder: Path, names: Sequence[str], usage: Callable[[str], Usage]) -> Iterable[tuple[Path, bytes]]:
    key = ec.generate_private_key(ec.SECP256R1())
    issuer = _named(_AUTHORITY_NAME)
    authority = (
        _certificate(issuer, issuer, key.public_key())
        .add_extension(x509.BasicConstraints(ca=True, path_length=0), critical=True)
        .sign(key, hashes.SHA256())
    )
    yield folder / AUTHORITY, authority.public_bytes(Encoding.PEM)
    for name in names:
        credentials, own = Credentials(folder, name), ec.generate_private_key(ec.SECP256R1())
        certificate = (
            _certificate(_named(name), issuer, own.public_key())
            .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
            .add_extension(x509.ExtendedKeyUsage(usage(name)), critical=False)
            .add_extension(x509.SubjectAlternativeName([x509.DNSName(name)]), critical=False)
            .sign(key, hashes.SHA256())
        )
        yield credentials.certificate, certificate.public_bytes(Encoding.PEM)
        yield credentials.key, own.private_bytes(Encoding.PEM, PrivateFormat.PKCS8, NoEncryption())


def _certificate(
    subject: x509.Name, issuer: x509.Name, public_key: ec.EllipticCurvePublicKey
) -> x509.CertificateBuilder:
    now = datetime.now(UTC)
    return x509.CertificateBuilder(
        issuer_name=issuer,
        subject_name=subject,
        public_key=public_key,
        serial_number=x509.random_serial_number(),
        not_valid_before=now - timedelta(days=BEFORE_DAYS),
        not_valid_after=now + timedelta(days=VALID_DAYS),
    )


def _named(common_name: str) -> x509.Name:
    return x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, common_name)])


def _write(path: Path, content: bytes) -> None:
    """A new file that nobody else may read, from its first byte on."""
    with os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "wb") as file:
        file.write(content)
