"""All that decides how a mission of a study goes, as one short name that changes when a source does.

It names the folder of what is compiled, and tells runs of a study that other rules have flown.
"""

from __future__ import annotations

import hashlib
from pathlib import Path

ROOT = Path(__file__).parent.parent.parent
# The pilots, the wires and the recorder take no part in what is compiled.
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


# Missions with faults are flown with all of it.
FLIGHT_SOURCES = (
    "comms/**/*.py",
    "swarm_agent/**/*.py",
    "vehicle_sim/**/*.py",
    "vehicle_sim/**/*.csv",
    *(f"missions/{name}" for name in ("coverage.py", "flight.py", "faults/*.py", "mission/*.py", "sides/*.py")),
    "missions/study/flights.py",
)


def sources_digest(*, flights: bool = False) -> str:
    """16 hexadecimal digits; with `flights`, of what flies missions with faults, too."""
    patterns = SOURCES + FLIGHT_SOURCES if flights else SOURCES
    paths = sorted({path for pattern in patterns for path in ROOT.glob(pattern)})
    whole = hashlib.sha256()
    for path in paths:
        whole.update(path.relative_to(ROOT).as_posix().encode() + b"\0" + path.read_bytes() + b"\0")
    return whole.hexdigest()[:16]
