"""A study of faults: its points have names, its runs are flown in process, and its table is right by hand."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from missions.cli import main
from missions.exit_codes import BAD_INPUT, DONE
from missions.load import load_mission
from missions.mission import Mission
from missions.overrides import Override
from missions.study.fault_table import fault_rows, faults_page, faults_table
from missions.study.flown import Flown, fly_point
from missions.study.load import dump_study, load_study
from missions.study.results import Results
from missions.study.shards import blocks
from missions.study.store import Store
from tests.missions.study.toy_runs import fly

STUDY = """name: broken
mission: quickstart
set: {duration_s: 120}
faults:
  none: []
  dark: [{kind: loss, at_s: 40, for_s: 20, share: 1}]
  gone: [{kind: kill, at_s: 40, agents: [0]}, {kind: reboot, at_s: 100, agents: [1]}]
runs: 2
"""


@pytest.fixture
def study(tmp_path: Path) -> Path:
    path = tmp_path / "broken.yaml"
    path.write_text(STUDY, encoding="utf-8")
    return path


def toy(mission: Mission, seeds: list[int]) -> Flown:
    """Without faults all ten targets are seen; in the dark half of them, and without an agent nine."""
    seen = np.full((len(seeds), 120), 100)
    noticed = None
    if len(mission.faults) == 1:
        seen[:, 40:60], noticed = 50, np.array([[2.5], [np.nan]])
    elif mission.faults:
        seen[:, 40:], noticed = 90, np.array([[1.0, 0.5], [3.0, 0.5]])
    return replace(fly(mission, seeds), seen=seen, present=np.full_like(seen, 100), noticed_s=noticed)


@pytest.fixture
def results(study: Path) -> Results:
    ready = load_study(str(study))
    return Results(ready, {point.digest: toy(point.mission, list(ready.seeds)) for point in ready.points})


def test_every_name_is_a_point(study: Path, tmp_path: Path) -> None:
    ready = load_study(str(study))
    assert [dict(point.labels)["faults"] for point in ready.points] == ["none", "dark", "gone"]
    assert [len(point.mission.faults) for point in ready.points] == [0, 1, 2]
    again = tmp_path / "again.yaml"
    again.write_text(dump_study(ready), encoding="utf-8")
    assert load_study(str(again)).points == ready.points


def test_the_table_by_hand(results: Results) -> None:
    rows = list(fault_rows(results))
    assert [(dict(row.point.labels)["faults"], row.fault.kind) for row in rows] == [
        ("dark", "loss"), ("gone", "kill"), ("gone", "reboot"),
    ]  # fmt: skip
    assert [(row.noticed, row.noticed_s) for row in rows] == [(0.5, 2.5), (1.0, 2.0), (1.0, 0.5)]
    # The window after the last fault begins when the mission has ended: there is nothing to tell.
    table = faults_table(results)
    assert table["before"] == [1.0, 1.0, 0.9]
    assert table["during"] == [0.5, 0.9, 0.9]
    assert table["after"] == [1.0, 0.9, None]
    assert table["cost_during"] == [0.5, pytest.approx(0.1), pytest.approx(0.1)]
    page = "\n".join(faults_page(results))
    assert "| dark | loss of 100%: all agents, for 20 s | after 2.5 s, in 50% of runs | 100.0 % (0.0 ± 0.0) |" in page


def test_without_faults_there_is_no_table(results: Results) -> None:
    calm = Results(replace(results.ready, points=results.ready.points[:1]), results.flown)
    assert faults_page(calm) == []
    assert faults_table(calm) == {}


def test_what_was_noticed_is_kept(results: Results, tmp_path: Path) -> None:
    store = Store(tmp_path / "kept")
    store.open(results.ready, fresh=False)
    for block in blocks(results.ready.points, results.ready.seeds):
        store.keep(block, results.flown[block.point.digest])
    for digest, flown in store.flown().items():
        np.testing.assert_equal(flown.noticed_s, results.flown[digest].noticed_s)


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("sweep: [{faults: [[], []]}]", 'sweep.0.faults: got a list of lists of faults; allowed: the study\'s faults'),
        ("faults: {a b: []}", "a b: got \"a b\""),
        ("faults: {x: [{kind: kill, at_s: 1, agents: [10]}]}", "3: faults.0.agents: got a list; allowed: numbers"),
        ("faults: {x: [{kind: loss, at_s: -1}]}", "at_s: got -1"),
        ("faults: {x: []}\nfigures: [{name: f, where: {faults: y}}]", 'where.faults: got "y"; allowed: "x"'),
    ],
)  # fmt: skip
def test_mistakes_are_told(text: str, line: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "wrong.yaml"
    path.write_text(f"name: wrong\nmission: quickstart\n{text}\n", encoding="utf-8")
    assert main(["study", str(path), "--out", str(tmp_path / "out")]) == BAD_INPUT
    assert line in capsys.readouterr().err


def test_a_fault_that_never_comes_is_flown_as_what_is_compiled() -> None:
    small = ("duration_s=20", "vehicle.kind=ideal", "agents.count=4", "targets.count=4")
    calm = load_mission("quickstart", overrides=[Override(text) for text in small])
    late = "faults=[{kind: kill, at_s: 1000, agents: [0]}]"
    warned = load_mission("quickstart", overrides=[Override(text) for text in (*small, late)])
    compiled, flown = fly_point(calm, [1, 2]), fly_point(warned, [1, 2], threads=1)
    np.testing.assert_array_equal(flown.seen, compiled.seen)
    np.testing.assert_array_equal(flown.present, compiled.present)
    np.testing.assert_array_equal(flown.counts, compiled.counts)
    np.testing.assert_array_equal(flown.late, compiled.late)
    assert flown.noticed_s is not None
    assert np.isnan(flown.noticed_s).all()


def test_shards_of_broken_missions_merge_to_the_whole(tmp_path: Path) -> None:
    path = tmp_path / "small.yaml"
    small = "{duration_s: 6, vehicle.kind: ideal, agents.count: 3, targets.count: 3}"
    faults = "{none: [], gone: [{kind: kill, at_s: 2, agents: [0]}]}"
    path.write_text(f"name: small\nmission: quickstart\nset: {small}\nfaults: {faults}\nruns: 4\n", encoding="utf-8")
    parts = [tmp_path / "1", tmp_path / "2"]
    fly_it = ["study", str(path), "--threads", "1", "--out"]
    for number, part in enumerate(parts, start=1):
        assert main([*fly_it, str(part), "--shard", f"{number}/2"]) == DONE
        assert not (part / "faults.csv").exists()
    assert main(["study", "merge", *map(str, parts), "--out", str(tmp_path / "merged")]) == DONE
    assert main([*fly_it, str(tmp_path / "whole")]) == DONE
    for table in ("faults.csv", "runs.csv"):
        assert (tmp_path / "merged" / table).read_text() == (tmp_path / "whole" / table).read_text()
    assert "kill: A0, to the end" in (tmp_path / "whole" / "faults.csv").read_text()
