"""Cut the excerpts in `recordings` out of the full recordings, which are not in this repository:

python -m tests.vehicle_sim.conformance.excerpt DIRECTORY
"""

from __future__ import annotations

import csv
import gzip
import json
import sys
from bisect import bisect_right
from pathlib import Path
from typing import Any, NamedTuple

RECORDINGS = Path(__file__).parent / "recordings"
STEP_S = 0.1


class Excerpt(NamedTuple):
    """`span_s` seconds of LOCAL_POSITION_NED from boot time `from_s` on, when the vehicle was told what to do."""

    name: str
    source: str
    from_s: float
    span_s: float
    fields: tuple[str, ...]


EXCERPTS = (
    Excerpt("takeoff_to_10_m", "flight_part1", 44.932, 10.0, ("z", "vz")),
    Excerpt("velocity_0_to_3_m_s", "flight_part1", 53.11, 7.5, ("x", "vx")),
    Excerpt("setpoints_stop_at_3_m_s", "flight_part1", 61.14, 7.9, ("x", "vx")),
    Excerpt("velocity_0_to_15_m_s", "flight_part1", 69.135, 8.0, ("x", "vx")),
    Excerpt("velocity_10_to_0_m_s", "flight_part1", 77.15, 6.0, ("x", "vx")),
    Excerpt("position_120_m_away", "flight_part1", 104.25, 17.0, ("x", "y", "z")),
    Excerpt("land_from_6_m", "flight2b", 110.857, 12.7, ("z", "vz")),
    Excerpt("motors_off_at_10_m", "probe3", 87.732, 1.4, ("z", "vz")),
)


class Said(NamedTuple):
    """STATUSTEXTs from `from_s` to `to_s` after power-on; by the wall clock where the boot clock was not sent yet."""

    name: str
    source: str
    from_s: float
    to_s: float
    by_wall: bool = False


SAID = (
    Said("boot_and_arm", "boot", 0.0, 53.0, by_wall=True),
    Said("failsafes_and_fall", "probe3", 74.0, 90.0),
    Said("landing", "flight2b", 107.0, 126.0),
)


def texts(path: Path, said: Said) -> list[str]:
    """One line a text: seconds, severity, words."""
    with gzip.open(path, "rt") as lines:
        heard = [json.loads(line) for line in lines]
    return [
        f"{at_s:7.2f} {message['severity']} {message['text']}"
        for wall_s, boot_s, _, _, message in heard
        if message["mavpackettype"] == "STATUSTEXT"
        and said.from_s <= (at_s := wall_s if said.by_wall else boot_s) <= said.to_s
    ]


def track(path: Path) -> list[tuple[float, dict[str, Any]]]:
    """Every LOCAL_POSITION_NED with its boot time in seconds."""
    with gzip.open(path, "rt") as lines:
        messages = [json.loads(line)[4] for line in lines]
    return [(m["time_boot_ms"] / 1000.0, m) for m in messages if m["mavpackettype"] == "LOCAL_POSITION_NED"]


def rows(points: list[tuple[float, dict[str, Any]]], excerpt: Excerpt) -> list[list[float]]:
    """The excerpt on an even grid, by straight lines between the messages."""
    times_s = [at_s for at_s, _ in points]
    grid: list[list[float]] = []
    for step in range(round(excerpt.span_s / STEP_S) + 1):
        at_s = excerpt.from_s + step * STEP_S
        after = min(max(1, bisect_right(times_s, at_s)), len(points) - 1)
        (a_s, a), (b_s, b) = points[after - 1], points[after]
        share = min(1.0, max(0.0, (at_s - a_s) / (b_s - a_s)))
        values = [a[field] + share * (b[field] - a[field]) for field in excerpt.fields]
        grid.append([round(step * STEP_S, 1), *(round(value, 3) for value in values)])
    return grid


def main(directory: Path) -> None:
    for excerpt in EXCERPTS:
        grid = rows(track(directory / f"{excerpt.source}.jsonl.gz"), excerpt)
        with (RECORDINGS / f"{excerpt.name}.csv").open("w", newline="") as out:
            writer = csv.writer(out, lineterminator="\n")
            writer.writerow(("time_s", *excerpt.fields))
            writer.writerows(grid)
    frames = json.loads((directory / "frames_hex.json").read_text())
    wires = {name: frame["hex"] for name, frame in frames.items() if not name.startswith("_")}
    for group in ("_acks", "_statustext"):
        wires |= {f"{group[1:]} {number}": frame["hex"] for number, frame in enumerate(frames[group])}
    (RECORDINGS / "frames.json").write_text(json.dumps(wires, indent=1) + "\n")
    for said in SAID:
        spoken = texts(directory / f"{said.source}.jsonl.gz", said)
        (RECORDINGS / f"{said.name}.txt").write_text("\n".join(spoken) + "\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
