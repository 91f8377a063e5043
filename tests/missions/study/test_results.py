"""What a study leaves in its folder: tables, figures that are not blank, captions and the page."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from xml.etree import ElementTree

import matplotlib.image
import numpy as np
import pyarrow.parquet
import pytest

from missions.exit_codes import DONE
from missions.plan import coverage_floor
from missions.study.claims import judged
from missions.study.command import StudyOptions, fly_paper, fly_study
from missions.study.figures import draw, panels_of, write_figure
from missions.study.fly import here
from missions.study.load import bundled_studies, load_study
from missions.study.results import Results
from missions.study.statistics import estimate
from missions.study.store import Store
from tests.missions.study.toy_runs import STUDY, fly


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the toy study, flown."""
    out = tmp_path_factory.mktemp("study")
    (out / "toy.yaml").write_text(STUDY, encoding="utf-8")
    assert fly_study(str(out / "toy.yaml"), StudyOptions(out=out / "toy"), flyer=here(fly)) == DONE
    return out / "toy"


@pytest.fixture(scope="module")
def results(folder: Path) -> Results:
    return Results(load_study(str(folder / "study.yaml")), Store(folder).flown())


def rows(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_every_run_has_a_row(folder: Path, results: Results) -> None:
    table = rows(folder / "runs.csv")
    assert len(table) == 8 * 7
    assert [int(row["seed"]) for row in table[:7]] == list(range(3, 10))
    last = table[-1]
    assert (last["agents.count"], last["targets.count"], last["policy"]) == ("10", "20", "default")
    share = results.of(results.ready.points[-1]).share()[-1]
    assert float(last["coverage"]) == pytest.approx(share)
    assert float(last["utilization"]) == pytest.approx(share * 2)


def test_every_point_has_its_interval(folder: Path, results: Results) -> None:
    told = {(row["point"], row["metric"]): row for row in rows(folder / "points.csv")}
    for point in results.ready.points:
        expected = estimate(results.of(point).share())
        row = told[str(point.number), "coverage"]
        assert [float(row[key]) for key in ("mean", "low", "high")] == pytest.approx(
            [expected.mean, expected.low, expected.high]
        )
        assert row["runs"] == "7"


def test_coverage_over_time_is_the_mean_of_each_second(folder: Path, results: Results) -> None:
    table = rows(folder / "over_time.csv")
    assert len(table) == 8 * 20
    shares = results.of(results.ready.points[1]).share_by_second()
    assert [float(row["coverage"]) for row in table[20:40]] == pytest.approx(shares.mean(axis=0).tolist())


@pytest.mark.parametrize("name", ["runs", "points", "over_time"])
def test_parquet_holds_what_csv_holds(name: str, folder: Path) -> None:
    table = pyarrow.parquet.read_table(folder / f"{name}.parquet").to_pylist()
    plain = rows(folder / f"{name}.csv")
    assert len(table) == len(plain)
    for typed, text in zip(table, plain, strict=True):
        assert typed.keys() == text.keys()
        assert all(str(typed[key]) == text[key] or float(typed[key]) == float(text[key]) for key in typed)


def test_seeds_and_versions_are_beside_them(folder: Path, results: Results) -> None:
    told = json.loads((folder / "manifest.json").read_text())
    assert (told["study"], told["runs"], told["seeds"]) == ("toy", 7, [3, 9])
    assert told["versions"].keys() >= {"python", "numba", "numpy", "pyarrow", "matplotlib"}
    assert list(told["points"]) == [point.digest for point in results.ready.points]
    assert load_study(str(folder / "study.yaml")).points == results.ready.points


@pytest.mark.parametrize("name", ["over-time", "by-count"])
def test_figures_are_not_blank(name: str, folder: Path) -> None:
    picture = matplotlib.image.imread(folder / f"{name}.png")
    height, width = picture.shape[:2]
    assert width > 600
    assert height > 400
    # Ink in every quarter, in several colors, and not all over.
    inked = (picture[:, :, :3] < 0.95).any(axis=2)
    quarters = [inked[y : y + height // 2, x : x + width // 2] for y in (0, height // 2) for x in (0, width // 2)]
    assert all(0.005 < quarter.mean() < 0.7 for quarter in quarters)
    assert len(np.unique((picture[::3, ::3, :3] * 15).round().reshape(-1, 3), axis=0)) > 30
    texts = " ".join(ElementTree.parse(folder / f"{name}.svg").getroot().itertext())
    assert "coverage" in texts
    assert "5 agents" in texts
    assert name == "over-time" or "targets" in texts


def test_a_figure_shows_the_numbers(results: Results) -> None:
    figure = results.ready.study.figures[1]
    canvas = draw(results, figure)
    assert canvas is not None
    basic, default = canvas.axes
    assert (basic.get_title(loc="left"), default.get_title(loc="left")) == ("basic", "default")
    lines = {str(line.get_label()): line for line in default.get_lines()}
    panels = panels_of(results, figure)
    assert [line.name for line in panels[1].lines] == ["5 agents, radius 10 m", "10 agents, radius 15 m"]
    for line in panels[1].lines:
        shown = lines[line.name]
        assert list(shown.get_xdata()) == [10.0, 20.0]
        assert list(shown.get_ydata()) == pytest.approx([results.of(point).share().mean() for point in line.points])
    floors = {round(coverage_floor(point.mission), 6) for point in results.ready.points}
    dim = {round(float(np.asarray(line.get_ydata())[0]), 6) for line in default.get_lines()} - {
        round(float(results.of(line.points[0]).share().mean()), 6) for line in panels[1].lines
    }
    assert dim == floors


def test_captions_say_what_is_claimed_and_what_was_measured(folder: Path, results: Results) -> None:
    text = (folder / "over-time.txt").read_text()
    assert text.startswith("Over time\n\nThe paper: Coverage rises.\n\nMeasured:\n- basic, 5 agents, radius 10 m, 10 ")
    shown = estimate(results.of(results.ready.points[0]).share())
    assert f"{100 * shown.mean:.1f} % ± {100 * shown.half:.1f} over the whole time" in text
    assert "Mean of 7 runs a point (seeds 3 to 9, the same for every point); intervals: 95 %, Student's t" in text
    assert "Static placement at random places would cover 15.7 % to 29.0 %." in text


def test_the_page_shows_figures_claims_and_policies(folder: Path) -> None:
    page = (folder / "index.md").read_text()
    assert "![Over time](over-time.png)" in page
    assert "- `basic`: name: b-cmommt-basic\n- `default`: the mission's defaults" in page
    assert "| figure 1 | The default covers more. | compared |" in page
    assert "**✔ confirmed**" in page


def test_the_same_runs_draw_the_same_figure(results: Results, tmp_path: Path) -> None:
    one, two = (write_figure(results, results.ready.study.figures[0], tmp_path / name) for name in "ab")
    assert [path.read_bytes() for path in one] == [path.read_bytes() for path in two]


@pytest.mark.parametrize("name", bundled_studies())
def test_bundled_studies_have_figures_and_claims_about_what_they_fly(name: str) -> None:
    ready = load_study(name, runs=2)
    whole = Results(ready, {point.digest: fly(point.mission, ready.seeds) for point in ready.points})
    assert all(panels_of(whole, figure) for figure in ready.study.figures)
    assert all(figure.title and (figure.paper or ready.study.faults) for figure in ready.study.figures)
    said = [judgement.claim for judgement in judged(whole)]
    assert all(claim in said for claim in ready.study.claims)


def test_studies_make_one_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    names = ["figure-17", "pair"]
    monkeypatch.setattr("missions.study.command.bundled_studies", lambda: names)
    assert fly_paper(StudyOptions(out=tmp_path, runs=2), flyer=here(fly)) == DONE
    page = (tmp_path / "index.md").read_text()
    assert "2 studies, 24 missions." in page
    for name in names:
        study = load_study(name).study
        assert f"## {name}" in page
        for figure in study.figures:
            assert f"({name}/{figure.name}.png)" in page
            assert all((tmp_path / name / f"{figure.name}.{ending}").stat().st_size > 0 for ending in ("png", "svg"))
        for claim in study.claims:
            assert f"| {claim.figure} | {claim.paper} |" in page
