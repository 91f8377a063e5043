"""All that decides how a mission of a study goes, as one short name that changes when a source does.

It names the folder of what is compiled, and tells runs of a study that other rules have flown.
"""

from __future__ import annotations

import hashlib
from pathlib import Path

ROOT = Path(__file__).parent.parent.parent
# The pilots, the wires and the recorder take no part in a study.
SOURCES = (
    *(f"comms/{name}.py" for name in ("arena", "chance", "frames", "link", "messages")),
    "swarm_agent/bcmommt/*.py",
    "swarm_agent/policies/*.py",
    *(f"vehicle_sim/{name}.py" for name in ("herd", "placement", "sensing", "targets", "track_rows", "tracks")),
    "missions/training/weights.json",
    "missions/compose.py",
    "missions/metrics.py",
    "missions/rules.py",
    "missions/study/engine.py",
    "missions/study/compiled/*.py",
)


def sources_digest() -> str:
    """16 hexadecimal digits."""
    paths = sorted(path for pattern in SOURCES for path in ROOT.glob(pattern))
    whole = hashlib.sha256()
    for path in paths:
        whole.update(path.relative_to(ROOT).as_posix().encode() + b"\0" + path.read_bytes() + b"\0")
    return whole.hexdigest()[:16]
