"""`swarm train`: fly study runs, find the situations, fit nets for two and three tags, and say how good they are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from rich.console import Console
from rich.progress import track

from missions.load import load_mission
from missions.mission import Mission
from missions.overrides import Override
from missions.problems import InputError
from missions.study.engine import trace
from missions.training.fit import fit, predict
from missions.training.rows import Floats, Rows, join, rows_of
from missions.training.situations import find_situations
from missions.training.weights import NetFile, Weights, write_weights
from swarm_agent.bcmommt.net import Net

# The logs are of the policy as the paper prints it; a helper that comes at once would end more situations.
AS_PRINTED = (
    "policy.predictor=direct",
    "policy.call=all_but_nearest",
    "policy.answer_gate=in_time",
    "policy.capture=intercept",
    "policy.help_margin_s=2",
    "policy.memory_s=0",
)
HIDDEN = {2: 6, 3: 8}
PAPER_MSE = 0.0045632105
PAPER_SITUATIONS = 253
HOLD_OUT_EVERY = 5  # every fifth run is held out: rows of one situation are never on both sides


class Split(NamedTuple):
    """The rows to fit to, and those held out."""

    fitted: Rows
    held_out: Rows


@dataclass(frozen=True, slots=True)
class Lesson:
    """What came of fitting one net. Errors are mean squares, times being shares of 20 s.

    Attributes:
        net_mse, direct_mse, mean_mse: of the net, of eq. 10, and of always saying the mean; on the fitted rows, then on
            those held out.
    """

    net: Net
    rows: Split
    net_mse: tuple[float, float]
    direct_mse: tuple[float, float]
    mean_mse: tuple[float, float]


def training_mission(name: str, overrides: Sequence[Override] = ()) -> Mission:
    """The mission whose runs are learned from: with the policy as printed, and `overrides` on top."""
    return load_mission(name, overrides=[*(Override(text) for text in AS_PRINTED), *overrides])


def collect(mission: Mission, seeds: Sequence[int], *, quiet: bool = True) -> dict[int, Split]:
    """The rows of all situations with two and with three tags.

    Raises:
        InputError: the runs have too few situations to fit to some and hold out others.
    """
    parts: dict[int, tuple[list[Rows], list[Rows]]] = {2: ([], []), 3: ([], [])}
    for number, seed in enumerate(track(seeds, "flying and parsing", disable=quiet, transient=True)):
        run = trace(mission, seed=seed)
        for n_tags, sides in parts.items():
            found = find_situations(run, n_tags, notice_range_m=mission.target_sensing_range_m)
            rows = rows_of(run, found, tick_s=mission.tick_s, range_m=mission.agents.sensing.range_m)
            if rows.situations:
                sides[number % HOLD_OUT_EVERY == HOLD_OUT_EVERY - 1].append(rows)
    for n_tags, sides in parts.items():
        if not all(sides):
            few = f"no situation with {n_tags} tags to {'hold out' if sides[0] else 'fit to'}"
            raise InputError(f"--runs: got {len(seeds)}; allowed: more ({few})")
    return {n_tags: Split(join(fitted), join(held_out)) for n_tags, (fitted, held_out) in parts.items()}


def learn(rows: Split, *, n_hidden: int, seed: int) -> Lesson:
    """Fit a net and measure it."""
    fitted, held_out = rows
    net = fit(fitted.inputs, fitted.teacher, n_hidden=n_hidden, seed=seed)
    mean = np.mean(fitted.teacher)
    return Lesson(
        net,
        rows,
        net_mse=(_mse(predict(net, fitted.inputs), fitted), _mse(predict(net, held_out.inputs), held_out)),
        direct_mse=(_mse(fitted.direct, fitted), _mse(held_out.direct, held_out)),
        mean_mse=(_mse(mean, fitted), _mse(mean, held_out)),
    )


def train(name: str, *, runs: int, seed: int, out: Path, overrides: Sequence[Override], console: Console) -> None:
    """Fly, fit, print the table, write the file.

    Raises:
        InputError: a mission that cannot be flown, too few runs, or a file that cannot be written.
    """
    mission = training_mission(name, overrides)
    seeds = range(seed, seed + runs)
    lessons = {
        n_tags: learn(rows, n_hidden=HIDDEN[n_tags], seed=seed)
        for n_tags, rows in collect(mission, seeds, quiet=not console.is_terminal).items()
    }
    about = f"{runs} runs of {mission.name} from seed {seed}, every fifth held out"
    console.print(f"{about}\n\n{table(lessons)}\n")
    pair, triple = (NetFile(*lesson.net) for lesson in (lessons[2], lessons[3]))
    try:
        write_weights(out, Weights(about, pair, triple))
    except OSError as error:
        raise InputError(f"--out: got {out} ({error.strerror}); allowed: a file that can be written") from error
    console.print(f"weights written to {out}; to fly them: --set policy.predictor=learned --set policy.weights={out}")


def table(lessons: dict[int, Lesson]) -> str:
    """What was learned, beside the paper's figures."""
    pair, triple = lessons[2], lessons[3]
    lines = [
        ("", "two tags", "three tags", "the paper, two tags"),
        ("situations", *(_count(x, "situations") for x in (pair, triple)), str(PAPER_SITUATIONS)),
        ("rows", *(_count(x, "rows") for x in (pair, triple)), "almost 11000"),
        ("net", *(_shape(x.net) for x in (pair, triple)), "3-6-1"),
    ]
    for side, where in enumerate(("fitted", "held out")):
        paper = f"{PAPER_MSE:.7f}" if where == "fitted" else ""
        lines += [
            (f"MSE, {where}: net", f"{pair.net_mse[side]:.7f}", f"{triple.net_mse[side]:.7f}", paper),
            ("  eq. 10", f"{pair.direct_mse[side]:.7f}", f"{triple.direct_mse[side]:.7f}", ""),
            ("  always the mean", f"{pair.mean_mse[side]:.7f}", f"{triple.mean_mse[side]:.7f}", ""),
        ]
    return "\n".join(f"{a:<20}{b:>16}{c:>16}  {d}".rstrip() for a, b, c, d in lines)


def _count(lesson: Lesson, what: str) -> str:
    sides = [rows.situations if what == "situations" else len(rows.teacher) for rows in lesson.rows]
    return f"{sides[0]} + {sides[1]}"


def _shape(net: Net) -> str:
    return f"{len(net.hidden[0]) - 2}-{len(net.hidden)}-1"


def _mse(shares: Floats | np.floating, rows: Rows) -> float:
    return float(np.mean((shares - rows.teacher) ** 2))
