"""Who one is on a secured network: a certificate of the swarm's own authority, and the key to it.

One folder holds `authority.pem`, and `NAME.pem` and `NAME.key` for each name: `world`, `recorder`, `operator`,
`agent-3`, or `agents-0-4` for a process that runs five. A computer needs the authority and what bears its own name; the
world also the certificates of those it lets in. The folder `radio` in it is of the same kind: by an authority of its
own the radios of agents know each other, where they speak directly.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

OPERATOR = "operator"
AUTHORITY = "authority.pem"
RADIO = "radio"
_AGENTS = re.compile(r"agent-(?P<one>\d{1,5})|agents-(?P<first>\d{1,5})-(?P<last>\d{1,5})")


@dataclass(frozen=True, slots=True)
class Credentials:
    """The files by which `name` is known, in `folder`."""

    folder: Path
    name: str

    @property
    def authority(self) -> Path:
        """The certificate that has signed all others."""
        return self.folder / AUTHORITY

    @property
    def certificate(self) -> Path:
        """Who it is: its common name is `name`."""
        return self.folder / f"{self.name}.pem"

    @property
    def key(self) -> Path:
        """What proves it, and nobody else may have."""
        return self.folder / f"{self.name}.key"

    @property
    def of_radio(self) -> Credentials:
        """Those by which its radio is known to other radios."""
        return Credentials(self.folder / RADIO, self.name)

    @property
    def missing(self) -> list[Path]:
        """Which of the files are not there."""
        return [file for file in (self.authority, self.certificate, self.key) if not file.is_file()]

    @property
    def known(self) -> list[str]:
        """The names whose certificates lie in the folder."""
        return sorted(file.stem for file in self.folder.glob("*.pem") if file.name != AUTHORITY)


def agents_name(uids: Sequence[int]) -> str:
    """What a process that runs these agents, one after the other, is called: `agent-3`, `agents-0-4`."""
    first, last = min(uids), max(uids)
    return f"agent-{first}" if first == last else f"agents-{first}-{last}"


def agents_named(name: str) -> range:
    """The agents that speak under this name; none if it is not of agents."""
    found = _AGENTS.fullmatch(name)
    if found is None:
        return range(0)
    if found["one"]:
        return range(int(found["one"]), int(found["one"]) + 1)
    return range(int(found["first"]), int(found["last"]) + 1)
