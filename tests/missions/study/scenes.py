"""Starts and policies of the theorems' tests."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from missions import compose
from missions.load import load_mission
from missions.mission import Mission
from missions.overrides import Override
from missions.study.compiled.state import REPLAY, Kept, Setup
from missions.study.engine import fly_setup, setup_of

AS_PRINTED = "policy={call: predicted, answer_gate: in_time, capture: worst_case, help_margin_s: 2, memory_s: 0}"
DEFAULT = "policy={}"
# What theorem 2 assumes: perfect prediction, and the optimal assignment of help calls.
ALL_KNOWING = AS_PRINTED.replace("}", ", predictor: perfect, horizon_s: 120, answering: optimal}")
POLICIES = {"as printed": AS_PRINTED, "default": DEFAULT}
NARROW = "agents.deployment.radius_m=5"

Floats = npt.NDArray[np.float64]
Place = tuple[float, float]


def mission(*changes: str) -> Mission:
    """The paper's world, ten agents and ten targets from within 15 m, with other values for some keys."""
    return load_mission("quickstart", overrides=[Override(text) for text in changes], for_study=True)


def one_to_one(mission: Mission) -> Setup:
    """Theorem 2's start: every agent right above its own target."""
    setup = setup_of(mission)
    return setup._replace(target_x=setup.home_x.copy(), target_y=setup.home_y.copy())


def fly_one_to_one(mission: Mission, seed: int, *, keep_all: bool = False, **rules: Any) -> Kept:
    """One mission from theorem 2's start; `rules` replaces constants of the agents' rules."""
    seeded = mission.model_copy(update={"seed": seed})
    return fly_setup(one_to_one(seeded), compose.params(mission)._replace(**rules), keep_all=keep_all)


def loses_sight(kept: Kept) -> bool:
    """Whether any target is ever out of everybody's sight."""
    return bool((kept.seen < kept.present).any())


def replay(mission: Mission, *, agents: list[Place], targets: list[Place], velocities: list[Place]) -> Kept:
    """A constructed case, flown: see `replayed`."""
    setup = replayed(mission, agents=agents, targets=targets, velocities=velocities)
    return fly_setup(setup, compose.params(mission), keep_all=True)


def replayed(mission: Mission, *, agents: list[Place], targets: list[Place], velocities: list[Place]) -> Setup:
    """A constructed case: agents at these places, and targets that go straight on at these velocities (m/s)."""
    setup = setup_of(mission)
    times = np.arange(setup.ticks) * mission.tick_s
    start, velocity = np.array(targets, np.float64), np.array(velocities, np.float64)
    tracks = start[None] + times[:, None, None] * velocity[None]
    homes = np.array(agents, np.float64)
    still: Floats = np.zeros(len(targets))
    return setup._replace(
        home_x=homes[:, 0].copy(), home_y=homes[:, 1].copy(),
        target_x=start[:, 0].copy(), target_y=start[:, 1].copy(), target_ux=still, target_uy=still.copy(),
        track_x=tracks[:, :, 0].copy(), track_y=tracks[:, :, 1].copy(), motion=REPLAY,
        heading_x=setup.heading_x[: len(agents)].copy(), heading_y=setup.heading_y[: len(agents)].copy(),
        sensing_range_m=setup.sensing_range_m[: len(agents)].copy(),
    )  # fmt: skip
