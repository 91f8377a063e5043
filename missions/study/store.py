"""The folder of a study: what it is of, and every block of runs that has been flown, each in a file of its own.

A file appears under its name only when it is whole, so a killed study has lost nothing but the block it was flying, and
several shards may share a folder.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any, TypeVar
from zipfile import BadZipFile

import numpy as np

from missions.problems import InputError
from missions.report import PACKAGES, versions
from missions.study.flown import Flown
from missions.study.load import ReadyStudy, dump_study
from missions.study.shards import Block
from missions.study.sources import sources_digest

STUDY, MANIFEST, BLOCKS = "study.yaml", "manifest.json", "blocks"
FORMAT = 2
_PACKAGES = (*PACKAGES, "numba", "numpy", "pyarrow", "matplotlib")
_NONE = np.zeros((0, 0))
R = TypeVar("R")


@dataclass(frozen=True, slots=True)
class Store:
    """The folder of one study."""

    folder: Path

    def open(self, ready: ReadyStudy, *, fresh: bool) -> None:
        """Begin a study in this folder, or go on with it; `fresh` throws away what another one left.

        Raises:
            InputError: the folder holds runs of other missions, or of other rules.
        """
        mine = manifest(ready)
        before = self.manifest()
        if fresh and before is not None:
            shutil.rmtree(self.folder / BLOCKS, ignore_errors=True)
        elif before is not None:
            self._compare(before, mine)
        (self.folder / BLOCKS).mkdir(parents=True, exist_ok=True)
        write_whole(self.folder / STUDY, dump_study(ready).encode())
        write_whole(self.folder / MANIFEST, (json.dumps(mine, indent=2) + "\n").encode())

    def manifest(self) -> dict[str, Any] | None:
        """What the folder's runs are of; None if it holds no study."""
        try:
            found = json.loads((self.folder / MANIFEST).read_text(encoding="utf-8"))
        except FileNotFoundError:
            return None
        except ValueError as error:
            raise InputError(f"{self.folder / MANIFEST}: got no JSON ({error}); allowed: --fresh") from error
        return found if isinstance(found, dict) else {}

    def done(self) -> dict[str, set[int]]:
        """The seeds that have been flown, by the point's digest."""
        found: dict[str, set[int]] = {}
        for digest, seeds in self._read(lambda file: (str(file["point"]), file["seeds"].tolist())):
            found.setdefault(digest, set()).update(seeds)
        return found

    def flown(self) -> dict[str, Flown]:
        """All runs, by the point's digest."""
        parts: dict[str, list[Flown]] = {}
        for digest, part in self._read(lambda file: (str(file["point"]), _flown(file))):
            parts.setdefault(digest, []).append(part)
        return {digest: first.joined(more) for digest, (first, *more) in parts.items()}

    def keep(self, block: Block, flown: Flown) -> None:
        """Write a block that has been flown."""
        out = BytesIO()
        np.savez_compressed(
            out,
            point=np.array(block.point.digest),
            seeds=flown.seeds,
            seen=flown.seen,
            present=flown.present,
            counts=flown.counts,
            late=flown.late,
            size=np.array([flown.n_agents, flown.n_targets]),
            noticed_s=_NONE if flown.noticed_s is None else flown.noticed_s,
        )
        seeds = hashlib.sha256(flown.seeds.tobytes()).hexdigest()[:12]
        write_whole(self.folder / BLOCKS / f"{block.point.digest}-{block.seeds[0]:010d}-{seeds}.npz", out.getvalue())

    def take_over(self, other: Store) -> None:
        """Copy the blocks of another folder of the same study into this one."""
        for path in sorted((other.folder / BLOCKS).glob("*.npz")):
            write_whole(self.folder / BLOCKS / path.name, path.read_bytes())

    def same_study(self, other: Store) -> None:
        """Raise InputError unless the runs of both folders are of one study."""
        self._compare(other.manifest() or {}, self.manifest() or {}, of=other.folder)

    def _compare(self, before: Mapping[str, Any], mine: Mapping[str, Any], of: Path | None = None) -> None:
        what = _difference(before, mine)
        if what is not None:
            way_out = "--fresh to fly all again, or another --out" if of is None else "folders of one study"
            raise InputError(f"{of or self.folder}: got {what}; allowed: {way_out}")

    def _read(self, take: Callable[[Any], R]) -> Iterator[R]:
        for path in sorted((self.folder / BLOCKS).glob("*.npz")):
            with _blaming(path), np.load(path, allow_pickle=False) as file:
                found = take(file)
            yield found


def manifest(ready: ReadyStudy) -> dict[str, Any]:
    """What a study is of: its points, its seeds, and the software that flies it."""
    return {
        "format": FORMAT,
        "study": ready.study.name,
        "runs": ready.study.runs,
        "seeds": [ready.seeds[0], ready.seeds[-1]],
        "points": {point.digest: dict(point.labels) for point in ready.points},
        "sources": sources_digest(flights=any(point.mission.faults for point in ready.points)),
        "versions": versions(_PACKAGES),
    }


def write_whole(path: Path, data: bytes) -> None:
    """Write a file so that, at any moment, all of it is there or nothing."""
    path.parent.mkdir(parents=True, exist_ok=True)
    scratch = path.with_name(f".{path.name}.{os.getpid()}.part")
    scratch.write_bytes(data)
    scratch.replace(path)


def _difference(before: Mapping[str, Any], mine: Mapping[str, Any]) -> str | None:
    """In words, why runs of `before` are none of `mine`; None if they are."""
    if before.get("format") != mine["format"]:
        return "runs in another format"
    old, new = before.get("points", {}), mine["points"]
    if old.keys() != new.keys():
        gone, come = len(old.keys() - new.keys()), len(new.keys() - old.keys())
        return f"runs of another study, {before.get('study')} ({gone} of its points are not here, {come} are new)"
    if before.get("sources") != mine["sources"]:
        return "runs that other rules flew (the source has changed since)"
    return None


def _flown(file: Any) -> Flown:
    n_agents, n_targets = file["size"].tolist()
    noticed_s = file["noticed_s"]
    return Flown(
        seeds=file["seeds"],
        seen=file["seen"],
        present=file["present"],
        counts=file["counts"],
        late=file["late"],
        n_agents=n_agents,
        n_targets=n_targets,
        noticed_s=noticed_s if noticed_s.size else None,
    )


@contextmanager
def _blaming(path: Path) -> Iterator[None]:
    try:
        yield
    except (OSError, ValueError, KeyError, BadZipFile, EOFError) as error:
        raise InputError(f"{path}: got a broken block ({error}); allowed: delete it, and it is flown again") from error
