"""A killed study goes on where it was; shards merged are the whole; a folder of another study is refused."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

from missions.exit_codes import DONE, FAILED
from missions.overrides import Override
from missions.problems import InputError
from missions.study.command import StudyOptions, fly_study, merge
from missions.study.fly import Landed, here
from missions.study.shards import Block, Shard
from missions.study.store import Store
from tests.missions.study.toy_runs import WITHOUT_FIGURES, fly

TABLES = ("runs.csv", "points.csv", "over_time.csv", "index.md", "study.yaml")


@pytest.fixture
def study(tmp_path: Path) -> str:
    path = tmp_path / "toy.yaml"
    path.write_text(WITHOUT_FIGURES, encoding="utf-8")
    return str(path)


class Counted:
    """Flies toy runs, notes which, and is killed after so many blocks."""

    def __init__(self, *, killed_after: int | None = None) -> None:
        self.units: list[tuple[str, int]] = []
        self._left = killed_after

    def __call__(self, blocks: Sequence[Block]) -> Landed:
        for block, flown in here(fly)(blocks):
            if self._left == 0:
                raise KeyboardInterrupt
            if self._left is not None:
                self._left -= 1
            self.units += [(block.point.digest, seed) for seed in block.seeds]
            yield block, flown


def results(folder: Path) -> dict[str, bytes]:
    return {name: (folder / name).read_bytes() for name in TABLES}


def test_a_killed_study_goes_on(study: str, tmp_path: Path) -> None:
    whole, first, second = Counted(), Counted(killed_after=3), Counted()
    assert fly_study(study, StudyOptions(out=tmp_path / "whole"), flyer=whole) == DONE
    options = StudyOptions(out=tmp_path / "killed")
    with pytest.raises(KeyboardInterrupt):
        fly_study(study, options, flyer=first)
    assert not (tmp_path / "killed" / "runs.csv").exists()
    assert fly_study(study, options, flyer=second) == DONE
    assert len(first.units) == 3 * 7
    assert first.units + second.units == whole.units
    assert results(tmp_path / "killed") == results(tmp_path / "whole")


def test_a_finished_study_flies_nothing_again(study: str, tmp_path: Path) -> None:
    options, again = StudyOptions(out=tmp_path / "out"), Counted()
    fly_study(study, options, flyer=here(fly))
    before = results(tmp_path / "out")
    assert fly_study(study, options, flyer=again) == DONE
    assert again.units == []
    assert results(tmp_path / "out") == before


def test_more_runs_fly_what_is_missing_and_fewer_nothing(study: str, tmp_path: Path) -> None:
    more, fewer = Counted(), Counted()
    fly_study(study, StudyOptions(out=tmp_path / "out"), flyer=here(fly))
    fly_study(study, StudyOptions(out=tmp_path / "out", runs=9), flyer=more)
    assert sorted({seed for _, seed in more.units}) == [10, 11]
    fly_study(study, StudyOptions(out=tmp_path / "out", runs=2), flyer=fewer)
    assert fewer.units == []
    assert len((tmp_path / "out" / "runs.csv").read_text().splitlines()) == 1 + 8 * 2


def test_a_half_written_block_is_no_block(study: str, tmp_path: Path) -> None:
    out = tmp_path / "out"
    with pytest.raises(KeyboardInterrupt):
        fly_study(study, StudyOptions(out=out), flyer=Counted(killed_after=1))
    (block,) = (out / "blocks").iterdir()
    (out / "blocks" / f".{block.name}.7.part").write_bytes(block.read_bytes()[:100])
    assert {len(seeds) for seeds in Store(out).done().values()} == {7}


def test_a_broken_block_is_named(study: str, tmp_path: Path) -> None:
    fly_study(study, StudyOptions(out=tmp_path / "out"), flyer=here(fly))
    block = next((tmp_path / "out" / "blocks").iterdir())
    block.write_bytes(block.read_bytes()[:200])
    with pytest.raises(InputError, match=f"{block.name}: got a broken block .* allowed: delete it"):
        fly_study(study, StudyOptions(out=tmp_path / "out"), flyer=here(fly))


def test_a_folder_of_another_study_is_refused_unless_fresh(study: str, tmp_path: Path) -> None:
    out = tmp_path / "out"
    fly_study(study, StudyOptions(out=out), flyer=here(fly))
    changed = StudyOptions(out=out, overrides=(Override("duration_s=10"),))
    with pytest.raises(InputError) as caught:
        fly_study(study, changed, flyer=here(fly))
    assert str(caught.value) == (
        f"{out}: got runs of another study, toy (8 of its points are not here, 8 are new); "
        "allowed: --fresh to fly all again, or another --out"
    )
    again = Counted()
    fresh = StudyOptions(out=out, overrides=changed.overrides, fresh=True)
    assert fly_study(study, fresh, flyer=again) == DONE
    assert len(again.units) == 8 * 7
    assert len((out / "over_time.csv").read_text().splitlines()) == 1 + 8 * 10


def test_runs_of_other_rules_are_refused(study: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    out = tmp_path / "out"
    fly_study(study, StudyOptions(out=out), flyer=here(fly))
    monkeypatch.setattr("missions.study.store.sources_digest", lambda flights: "0" * 16)
    with pytest.raises(InputError, match=r"runs that other rules flew \(the source has changed since\); allowed: --fr"):
        fly_study(study, StudyOptions(out=out), flyer=here(fly))


@pytest.mark.parametrize("count", [2, 3, 9])
def test_merged_shards_are_the_whole(count: int, study: str, tmp_path: Path) -> None:
    fly_study(study, StudyOptions(out=tmp_path / "whole"), flyer=here(fly))
    parts = [tmp_path / f"part{index}" for index in range(1, count + 1)]
    for index, part in enumerate(parts, start=1):
        options = StudyOptions(out=part, shard=Shard(index, count))
        assert fly_study(study, options, flyer=here(fly)) == DONE
        assert not (part / "runs.csv").exists()
    assert merge(parts, tmp_path / "all") == DONE
    assert results(tmp_path / "all") == results(tmp_path / "whole")


def test_shards_may_share_a_folder(study: str, tmp_path: Path) -> None:
    fly_study(study, StudyOptions(out=tmp_path / "whole"), flyer=here(fly))
    for index in (2, 1):
        fly_study(study, StudyOptions(out=tmp_path / "both", shard=Shard(index, 2)), flyer=here(fly))
    assert results(tmp_path / "both") == results(tmp_path / "whole")


def test_a_merge_that_lacks_a_shard_says_so(study: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    fly_study(study, StudyOptions(out=tmp_path / "part", shard=Shard(1, 2)), flyer=here(fly))
    capsys.readouterr()
    assert merge([tmp_path / "part"], tmp_path / "all") == FAILED
    assert "28 of 56 runs are missing" in capsys.readouterr().err


def test_only_parts_of_one_study_merge(study: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="got no study; allowed: a folder that swarm study has written"):
        merge([tmp_path], tmp_path / "all")
    fly_study(study, StudyOptions(out=tmp_path / "a"), flyer=here(fly))
    fly_study(study, StudyOptions(out=tmp_path / "b", policies=("basic",)), flyer=here(fly))
    with pytest.raises(InputError) as caught:
        merge([tmp_path / "a", tmp_path / "b"], tmp_path / "all")
    assert str(caught.value) == (
        f"{tmp_path / 'b'}: got runs of another study, toy (0 of its points are not here, 4 are new); "
        "allowed: folders of one study"
    )
