"""How the agents of a mission decide."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field

from missions.mission.part import Allowed, NonNegative, Part, Positive, Span


class Policy(Part):
    """How agents decide. Keys that a policy has no use for, it leaves unread."""

    name: Literal["a-cmommt", "b-cmommt-basic", "b-cmommt", "regions"] = "b-cmommt"
    """The policy: Parker's force sum, the paper's section 4.1, its Algorithm 1, or regions after Jung & Sukhatme."""
    predictor: Literal["direct", "learned", "none", "perfect"] = "direct"
    """Foresees losses: `direct` is eq. 10 of the paper, `learned` its net for two and three tags, `none` nothing,
    `perfect` (in a study alone) what will happen if nobody helps."""
    weights: Annotated[Path | None, Field(strict=False), Allowed("null, or the path of a weights file")] = None
    """Weights of the learned predictor, written by `swarm train`; none: those that come with the package."""
    call: Literal["predicted", "all_but_nearest"] = "all_but_nearest"
    """Which of its targets an agent calls help for: those it expects to lose, or all but the nearest."""
    answer_gate: Literal["in_time", "always"] = "always"
    """Which calls are answered: those where capture comes before the loss, or all."""
    answering: Literal["distributed", "optimal"] = "distributed"
    """Who decides which call an agent answers: itself, or (in a study alone) a referee who knows all (eq. 15)."""
    capture: Literal["worst_case", "intercept"] = "intercept"
    """How the time to capture is estimated: the target flees straight away (eq. 13), or keeps its velocity."""
    help_margin_s: NonNegative = 40.0
    """A helper sets out this long before it must."""
    commitment: bool = True
    """Whether a helper stays with the call it has answered."""
    memory_s: Span = 60.0
    """How long a lost target is remembered at its predicted place."""
    explore: Literal["persistent-walk", "stale-first"] = "persistent-walk"
    """How idle agents search: a walk with a steady heading, or to the place not seen for longest."""
    standoff_m: NonNegative | None = None
    """Distance kept to a followed target; 0: right above it; none: 0, or with a sector a third of its range."""
    turn_time_s: Span = 0.5
    """Time an agent takes to turn (delta of eq. 13)."""
    horizon_s: Annotated[float, Field(gt=0, le=3600)] = 20.0
    """Losses further ahead are not foreseen, nor in other policies the places of targets unseen for longer."""
    tag_lease_s: Positive = 0.5
    """A claim of a target expires unless renewed within this time."""
    help_lease_s: Positive = 1.0
    """Calls and answers expire unless renewed within this time."""
    follow_gain_per_s: Positive = 1.0
    """Wanted speed per meter of distance from the followed point."""
