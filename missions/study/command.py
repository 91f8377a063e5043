"""`swarm study`: the shell around a study. Files, terminal, cores and clusters are here."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from rich.console import Console

from missions.exit_codes import DONE, FAILED
from missions.overrides import Override
from missions.problems import InputError
from missions.study.bar import StudyBar, work_of
from missions.study.flown import fly_point
from missions.study.fly import Flyer, here, on_cluster
from missions.study.load import ReadyStudy, bundled_studies, load_study
from missions.study.pages import write_index, write_study
from missions.study.results import Results
from missions.study.shards import WHOLE, Shard, blocks
from missions.study.store import STUDY, Store
from missions.training import figure7

OUT = Path("out") / "study"
OURS = {"faults"}  # no experiment of the paper


@dataclass(frozen=True, slots=True, kw_only=True)
class StudyOptions:
    """Options of `swarm study`.

    Attributes:
        runs, seed, policies, overrides: other ones than the study's own. out: the folder; None is out/study/NAME.
        shard: the part to fly. dask: a scheduler's address. fresh: whether to throw away what the folder holds.
        threads: cores to use; None is all.
    """

    runs: int | None = None
    seed: int | None = None
    policies: tuple[str, ...] = ()
    overrides: tuple[Override, ...] = ()
    out: Path | None = None
    shard: Shard = WHOLE
    dask: str | None = None
    fresh: bool = False
    threads: int | None = None


def fly_study(name_or_path: str, options: StudyOptions, *, flyer: Flyer | None = None) -> int:
    """Fly a study, or what is left of it, and write its tables, figures and page. Returns the exit code.

    Raises:
        InputError: mistakes in the study, a folder of another study, no cluster.
    """
    console = Console(stderr=True, highlight=False)
    results = _flown(name_or_path, options, options.out, console, flyer or _flyer(options))
    if results is not None:
        _say(console, write_study(results, _folder(results.ready, options.out)))
    return DONE


_FIGURE_7 = (
    "## figure-7",
    "",
    "What the bundled net for two tags says of every situation there can be; `swarm train` prints its errors.",
    "",
    f"![The learned predictor for two tags]({figure7.NAME}.png)",
)


def fly_paper(options: StudyOptions, *, flyer: Flyer | None = None) -> int:
    """Fly the paper's studies into one folder, with a page over all of them."""
    console = Console(stderr=True, highlight=False)
    folder = options.out or OUT / "paper"
    flyer = flyer or _flyer(options)
    whole: list[Results] = []
    # The paper's own figures first.
    names = sorted(set(bundled_studies()) - OURS, key=lambda name: (not name.startswith("figure"), name))
    for name in names:
        results = _flown(name, options, folder / name, console, flyer)
        if results is not None:
            write_study(results, folder / name)
            whole.append(results)
    if len(whole) == len(names):
        figure7.write(folder)
        title = "The experiments of the paper, flown again"
        _say(console, write_index(whole, folder, title=title, closing=_FIGURE_7))
    return DONE


def merge(folders: Sequence[Path], out: Path | None) -> int:
    """Put the runs of several folders of one study together, and write its results. Returns the exit code.

    Raises:
        InputError: a folder without a study, or folders of different ones.
    """
    console = Console(stderr=True, highlight=False)
    stores = [Store(folder) for folder in folders]
    for store in stores:
        if store.manifest() is None:
            raise InputError(f"{store.folder}: got no study; allowed: a folder that swarm study has written")
    first = stores[0]
    ready = load_study(str(first.folder / STUDY))
    target = Store(_folder(ready, out))
    for store in stores[1:]:
        first.same_study(store)
    target.open(ready, fresh=False)
    for store in stores:
        if store.folder.resolve() != target.folder.resolve():
            target.take_over(store)
    results = Results(ready, target.flown())
    if results.missing:
        console.print(f"{results.missing} of {_runs(ready)} runs are missing: fly the other shards, or")
        console.print(f"  swarm study {target.folder / STUDY} --out {target.folder}")
        return FAILED
    _say(console, write_study(results, target.folder))
    return DONE


def _flown(
    name_or_path: str, options: StudyOptions, out: Path | None, console: Console, flyer: Flyer
) -> Results | None:
    """All runs of a study, once it is complete; None while other shards are missing."""
    ready = load_study(
        name_or_path,
        runs=options.runs,
        seed=options.seed,
        policies=options.policies,
        overrides=options.overrides,
    )
    store = Store(_folder(ready, out))
    store.open(ready, fresh=options.fresh)
    left = list(blocks(ready.points, ready.seeds, shard=options.shard, done=store.done()))
    runs = sum(len(block.seeds) for block in left)
    bar = StudyBar(console, name=ready.study.name, runs=runs, work=sum(map(work_of, left)))
    with bar, closing(flyer(left)) as landed:
        for block, flown in landed:
            store.keep(block, flown)
            bar.landed(block)
    results = Results(ready, store.flown())
    if not results.missing:
        return results
    console.print(f"shard {options.shard}: done, {store.folder}; {results.missing} of {_runs(ready)} runs are missing")
    console.print("  when all shards are done: swarm study merge DIR...")
    return None


def _flyer(options: StudyOptions) -> Flyer:
    fly = partial(fly_point, threads=options.threads)
    return here(fly) if options.dask is None else on_cluster(options.dask, fly)


def _folder(ready: ReadyStudy, out: Path | None) -> Path:
    return out or OUT / ready.study.name


def _runs(ready: ReadyStudy) -> int:
    return len(ready.points) * ready.study.runs


def _say(console: Console, page: Path) -> None:
    console.print(str(page), soft_wrap=True)
