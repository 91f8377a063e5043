"""`swarm study` and `swarm train`: thousands of missions, compared and learned from."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from missions.arguments import count, new_file, whole
from missions.commands.command import Command, need_extra
from missions.commands.which import add_set, changes, mission_help
from missions.exit_codes import DONE
from missions.load import LIBRARY
from missions.problems import InputError

if TYPE_CHECKING:
    from missions.study.shards import Shard

_STUDY_PACKAGES = ("numpy", "numba", "pyarrow", "matplotlib")
_TRAIN_PACKAGES = ("numpy", "numba", "torch")

_STUDY = """examples:
  swarm study figure-16 --runs 20      tables, figures and claims in out/study/figure-16/
  swarm study paper                    every experiment of the paper, and a page over all of them
  swarm study my.yaml --policy b-cmommt --set duration_s=60 --out out/mine
  swarm study my.yaml --shard 2/4 --out part2; swarm study merge part1 part2 part3 part4 --out all
  swarm study my.yaml --dask tcp://10.0.0.5:8786

A study that is stopped goes on where it was when it is started again."""

_TRAIN = """examples:
  swarm train                          50 runs, as in the paper
  swarm train --runs 400 --out my.json
  swarm train my.yaml --set agents.sensing.range_m=4 --out short.json
  swarm launch quickstart --set policy.predictor=learned --set policy.weights=my.json

Flies the mission once for every seed, by the policy as the paper prints it; finds the situations in which one agent
has two (three) targets until it loses one and nobody interferes; fits a net for two tags and one for three. Every fifth
run is held out. Prints rows and errors beside the paper's and those of eq. 10."""


def _add_study(parser: argparse.ArgumentParser) -> None:
    studies = sorted(path.stem for path in (LIBRARY / "studies").glob("*.yaml"))
    about = f"path of a study file, a bundled study ({', '.join(studies)}), paper, or merge DIR..."
    parser.add_argument("study", nargs="+", metavar="STUDY", help=about)
    parser.add_argument("--runs", type=count, metavar="N", help="fly every point N times")
    parser.add_argument("--seed", type=whole, metavar="N", help="the first run's seed; the next run has the next")
    parser.add_argument(
        "--policy", action="append", default=[], metavar="P", help="fly this policy, and not all; may be repeated"
    )
    add_set(parser)
    parser.add_argument("--out", type=Path, metavar="DIR", help="the folder of the results")
    parser.add_argument("--fresh", action="store_true", help="throw away what the folder holds, and fly all again")
    parser.add_argument("--shard", type=_shard, metavar="i/N", help="fly part i of N alone")
    parser.add_argument("--dask", metavar="ADDRESS", help="fly on the Dask cluster whose scheduler is there")
    parser.add_argument("--threads", type=count, metavar="N", help="use so many cores, and not all")


def _study(options: argparse.Namespace) -> int:
    """Fly a study, all of the paper's, or merge what several computers have flown."""
    need_extra("study", "study", _STUDY_PACKAGES)
    from missions.study.command import StudyOptions, fly_paper, fly_study, merge
    from missions.study.shards import WHOLE

    name, *folders = options.study
    if name == "merge" and folders:
        return merge([Path(folder) for folder in folders], options.out)
    if folders or name == "merge":
        allowed = "one study, paper, or merge and the folders to merge"
        raise InputError(f'STUDY: got "{" ".join(options.study)}"; allowed: {allowed}')
    settings = StudyOptions(
        runs=options.runs,
        seed=options.seed,
        policies=tuple(options.policy),
        overrides=tuple(changes(options.set)),
        out=options.out,
        shard=options.shard or WHOLE,
        dask=options.dask,
        fresh=options.fresh,
        threads=options.threads,
    )
    return fly_paper(settings) if name == "paper" else fly_study(name, settings)


def _add_train(parser: argparse.ArgumentParser) -> None:
    about = f"{mission_help()}; quickstart unless given"
    parser.add_argument("mission", nargs="?", default="quickstart", metavar="MISSION", help=about)
    parser.add_argument("--runs", type=count, default=50, metavar="N", help="learn from N runs (default: 50)")
    parser.add_argument("--seed", type=whole, default=1, metavar="N", help="the first run's seed, and the fit's")
    add_set(parser)
    parser.add_argument(
        "--out", type=new_file, default=Path("weights.json"), metavar="F.json", help="the file of weights to write"
    )


def _train(options: argparse.Namespace) -> int:
    need_extra("train", "study", _TRAIN_PACKAGES)
    from rich.console import Console

    from missions.training.train import train

    console = Console(soft_wrap=True, markup=False, emoji=False, highlight=False)
    overrides = changes(options.set)
    train(options.mission, runs=options.runs, seed=options.seed, out=options.out, overrides=overrides, console=console)
    return DONE


def _shard(text: str) -> Shard:
    from missions.study.shards import Shard

    index, _, count = text.partition("/")
    if not (index.isdigit() and count.isdigit() and 1 <= int(index) <= int(count)):
        raise argparse.ArgumentTypeError(f'got "{text}"; allowed: i/N with i from 1 to N, such as 2/4')
    return Shard(int(index), int(count))


STUDY = Command(
    name="study",
    summary="fly many missions and compare them",
    examples=_STUDY,
    add_options=_add_study,
    run=_study,
)
TRAIN = Command(
    name="train",
    summary="fit the learned predictor",
    examples=_TRAIN,
    add_options=_add_train,
    run=_train,
)
