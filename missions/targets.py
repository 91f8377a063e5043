"""From a mission to its targets: where they start, and how they move."""

from __future__ import annotations

from functools import lru_cache
from itertools import chain
from pathlib import Path

from comms.arena import Arena, edge_distance_m
from comms.chance import PLACE_TARGET
from comms.frames import GeoPoint
from missions.mission import Mission, TrackTargets
from missions.problems import InputError
from vehicle_sim.herd import Evasive, Herd, Random, Replay, Static
from vehicle_sim.placement import heading, scatter
from vehicle_sim.tracks import Tracks, TracksError, read_tracks


@lru_cache(maxsize=4)
def _read(file: Path, home: GeoPoint | None, max_gap_s: float, stamp: tuple[int, int]) -> Tracks:
    """The runs of a study over one file read it once. `stamp` (time of change, size) tells one file from the next."""
    return read_tracks(file, home=home, max_gap_s=max_gap_s)


def herd(mission: Mission) -> Herd:
    """The targets, at the places where the mission finds them.

    Raises:
        InputError: a file of tracks that cannot be read, or of another place: not one fix lies in the arena.
    """
    arena, targets, tick_s, seed = mission.arena.area, mission.targets, mission.tick_s, mission.seed
    if isinstance(targets, TrackTargets):
        tracks = _tracks(targets, mission.home.place)
        _check_place(tracks, targets, arena)
        return Replay(arena=arena, tracks=tracks, tick_s=tick_s, start_s=targets.start_s)
    places = scatter(
        count=targets.count, radius_m=targets.deployment.radius_m, spacing_m=0.0, seed=seed, purpose=PLACE_TARGET
    )
    headings = [heading(who=target, seed=seed, purpose=PLACE_TARGET) for target in range(targets.count)]
    if targets.motion == "static":
        return Static(arena=arena, places=places, headings=headings, tick_s=tick_s, seed=seed)
    if targets.motion == "random":
        return Random(
            arena=arena, places=places, headings=headings, tick_s=tick_s, seed=seed, speed_m_s=targets.speed_m_s
        )
    return Evasive(
        arena=arena,
        places=places,
        headings=headings,
        tick_s=tick_s,
        seed=seed,
        speed_m_s=targets.speed_m_s,
        notice_range_m=mission.target_sensing_range_m,
    )


def n_targets(mission: Mission) -> int:
    """How many targets there are, or will be."""
    targets = mission.targets
    return len(herd(mission).places) if isinstance(targets, TrackTargets) else targets.count


def _check_place(tracks: Tracks, targets: TrackTargets, arena: Arena) -> None:
    fixes = zip(chain(*tracks.x_m), chain(*tracks.y_m), strict=True)
    if any(edge_distance_m(arena, x, y) >= 0.0 for x, y in fixes):
        return
    origin = _tracks(targets, None).origin
    hint = "an arena that holds its tracks"
    if origin is not None:
        hint = f"home: {{latitude_deg: {origin.latitude_deg:.7f}, longitude_deg: {origin.longitude_deg:.7f}}}"
    raise InputError(f"{targets.file}: targets.file: got tracks that are nowhere inside the arena; allowed: {hint}")


def _tracks(targets: TrackTargets, home: GeoPoint | None) -> Tracks:
    try:
        state = targets.file.stat()
        return _read(targets.file, home, targets.max_gap_s, (state.st_mtime_ns, state.st_size))
    except (TracksError, OSError) as error:
        raise InputError(str(error)) from error
