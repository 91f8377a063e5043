"""What a study is, as its file has it: a mission, what to vary in it, how often to fly it, what to draw and to claim.

The keys of the mission itself appear here only as names (`agents.count`): `missions.study.load` checks them by making
every mission of the study.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from missions.mission import Allowed, Name, NonNegative, Part, Positive

Seconds = Annotated[float, Field(ge=0)]
Keys = Annotated[dict[str, Any], Allowed("a mapping of keys to values, such as {agents.count: 5}")]
Where = Annotated[
    dict[str, Any], Allowed("a mapping of what is varied to one value or a list, such as {policy: basic}")
]
Metric = Literal[
    "coverage",
    "coverage_late",
    "utilization",
    "lowest",
    "escaped",
    "target_loss",
    "target_discovery",
    "tag_switch",
    "calls",
    "answered",
    "captured",
    "taken_over",
    "pursued",
    "found_again",
]
Expect = Literal["above", "below", "about", "closer", "insignificant"]


class Figure(Part):
    """A figure to draw; its lines are told apart by all that varies and is not on its x axis."""

    name: Name
    """Names the files."""
    title: str = ""
    """Stands above the figure."""
    x: Annotated[str, Allowed("time, ratio, agents, targets, or a key that is swept")] = "time"
    """`time`; `ratio` of targets to agents; `agents` and `targets`: how many; or a swept key."""
    y: Metric = "coverage"
    """What is drawn; over time `coverage` or `utilization`."""
    where: Where = Field(default_factory=dict)
    """Which points: all, or those with these values."""
    until_s: Positive | None = None
    """Draws and averages the mission up to then alone; null: all of it."""
    x_label: str = ""
    """Names the x axis; made from `x` unless given."""
    paper: str = ""
    """What the paper says about it, for the caption."""


class Check(Part):
    """A comparison of one number with another, or with a point and a number, over all runs.

    Where `of` leaves open what is varied, the check is made for each value of that alone.
    """

    metric: Metric = "coverage"
    """The number."""
    of: Where = Field(default_factory=dict)
    """Of which points."""
    from_s: Seconds = 0.0
    """Coverage and utilization count from here."""
    until_s: Positive | None = None
    """And up to here; null: to the end."""
    expect: Expect = "above"
    """How it should compare; `closer`: nearer to `than` in this window of time than in `than`'s window."""
    than: Where | None = None
    """What differs in the points compared with; null: nothing does, or `value` is compared with."""
    than_metric: Metric | None = None
    """The number compared with; null: the same."""
    than_from_s: Seconds | None = None
    """Its window of time; null: the same."""
    than_until_s: Positive | None = None
    """And its end; null: the same."""
    value: float | None = None
    """A plain number to compare with."""
    within: NonNegative = 0.0
    """`about`: how far apart is still the same; `above` and `below`: by how much at least."""


class Claim(Part):
    """Something the paper states, and what has to hold for it to be confirmed."""

    paper: str
    """What is stated."""
    figure: str
    """Where."""
    checks: Annotated[tuple[Check, ...], Field(strict=False, min_length=1), Allowed("a list of checks")]
    """All have to hold."""


class Study(Part):
    """A whole study."""

    name: Name
    """Names the study and its folder."""
    description: str = ""
    """One line for people."""
    mission: str
    """A bundled mission, or the path of a mission file from this file's folder."""
    set: Keys = Field(default_factory=dict)
    """Other values for keys of the mission, as `--set` gives them."""
    sweep: Annotated[
        tuple[dict[str, list[Any]], ...],
        Field(strict=False),
        Allowed("a list of axes, such as [{agents.count: [5, 10]}]"),
    ] = ()
    """Axes: every combination is flown. Keys of one axis go in step, value by value."""
    policies: Annotated[
        dict[str, dict[str, Any]],
        Allowed("a mapping of names to keys of the mission's policy, such as {basic: {name: b-cmommt-basic}}"),
    ] = Field(default_factory=dict)
    """The policies compared, by the name they have in figures and tables; none: the mission's own."""
    faults: Annotated[
        dict[str, list[Any]],
        Allowed(
            "a mapping of names to lists of faults, such as {none: [], kill: [{kind: kill, at_s: 60, agents: [0]}]}"
        ),
    ] = Field(default_factory=dict)
    """What goes wrong, by the name it has in figures and tables; none: the mission's own faults."""
    runs: Annotated[int, Field(ge=1, le=1_000_000)] = 100
    """Missions for each point."""
    seed: Annotated[int, Field(ge=0, le=4294967295)] = 1
    """Of each point's first run; the next run has the next seed. All points have the same seeds."""
    figures: Annotated[tuple[Figure, ...], Field(strict=False), Allowed("a list of figures")] = ()
    """What to draw."""
    claims: Annotated[tuple[Claim, ...], Field(strict=False), Allowed("a list of claims")] = ()
    """What to confirm or refute."""
