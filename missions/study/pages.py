"""The pages a study leaves: `index.md` with figures, captions and claims, and one such page over several studies."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from missions.study.captions import caption, conditions, policy_words
from missions.study.claims import Judgement, Verdict, judged
from missions.study.fault_table import faults_page, faults_table
from missions.study.figures import panels_of, write_figure
from missions.study.results import Results, write_tables
from missions.study.store import write_whole

INDEX = "index.md"
_MARKS = {Verdict.CONFIRMED: "✔ confirmed", Verdict.REFUTED: "✘ refuted", Verdict.OPEN: "? open"}
_HOW = (
    "Every check compares means over runs: confirmed when all of the 95 % interval (Student's t over runs; seed by "
    "seed where two points are compared) agrees with it, refuted when none of it does, open in between. A claim is "
    "refuted by one refuted check and confirmed when all are. The checks are not corrected for their number."
)


def write_study(results: Results, folder: Path) -> Path:
    """Write tables, figures, captions and the page of one study; returns the page."""
    write_tables(results, folder, {"faults": faults_table(results)})
    for figure in results.ready.study.figures:
        if write_figure(results, figure, folder):
            write_whole(folder / f"{figure.name}.txt", caption(results, figure).encode())
    page = folder / INDEX
    write_whole(page, _study_page(results).encode())
    return page


def write_index(studies: Sequence[Results], folder: Path, *, title: str, closing: Sequence[str] = ()) -> Path:
    """Write one page over several studies, each in the folder of its name beside it; returns the page.

    Args:
        closing: lines of Markdown for the end of the page.
    """
    judgements = [judgement for results in studies for judgement in judged(results)]
    runs = sum(len(results.ready.points) * results.ready.study.runs for results in studies)
    lines = [f"# {title}", "", f"{len(studies)} studies, {runs} missions.", ""]
    lines += [_tally(judgements), "", _HOW, "", *claims_table(judgements), ""]
    for results in studies:
        name = results.ready.study.name
        lines += [f"## {name}", "", results.ready.study.description, "", f"[Tables and data]({name}/{INDEX})", ""]
        lines += _figures(results, prefix=f"{name}/")
    lines += closing
    page = folder / INDEX
    write_whole(page, ("\n".join(lines).rstrip() + "\n").encode())
    return page


def claims_table(judgements: Iterable[Judgement]) -> list[str]:
    """Every claim with what was measured and what follows, as a Markdown table."""
    rows = ["| Where | Claim | Policy | Measured | Verdict |", "|---|---|---|---|---|"]
    for judgement in judgements:
        claim = judgement.claim
        several = len(judgement.findings) > 1
        measured = [f"{f.measured} ({f.verdict})" if several else f.measured for f in judgement.findings]
        cells = (
            claim.figure,
            claim.paper,
            judgement.policy or "compared",
            "<br>".join(measured),
            f"**{_MARKS[judgement.verdict]}**",
        )
        rows.append("| " + " | ".join(cell.replace("|", "\\|").replace("\n", " ").strip() for cell in cells) + " |")
    return rows


def _study_page(results: Results) -> str:
    study, points = results.ready.study, results.ready.points
    lines = [f"# {study.name}", "", study.description, "", *(f"- {line}" for line in conditions(results, points)), ""]
    lines += ["Policies:", "", *(f"- {line}" for line in policy_words(points)), ""]
    judgements = judged(results)
    if judgements:
        lines += ["## Claims", "", _tally(judgements), "", _HOW, "", *claims_table(judgements), ""]
    lines += faults_page(results)
    lines += ["## Figures", "", *_figures(results, prefix="")] if study.figures else []
    lines += [
        "## Data",
        "",
        "- `runs`: one row for every run. `points`: mean and interval of every number at every point. `over_time`: "
        "mean coverage and interval of every second at every point. Each as CSV and Parquet.",
        "- `study.yaml`: the study with all of its mission written out. `manifest.json`: seeds, points and versions.",
        "- `blocks`: the runs themselves; a study that is started again goes on with them.",
    ]
    return "\n".join(lines) + "\n"


def _figures(results: Results, *, prefix: str) -> list[str]:
    lines: list[str] = []
    for figure in results.ready.study.figures:
        if not panels_of(results, figure):
            continue
        lines += [f"![{figure.title or figure.name}]({prefix}{figure.name}.png)", ""]
        title, *text = caption(results, figure).splitlines()
        lines += [f"**{title}**", *text, ""]
    return lines


def _tally(judgements: Sequence[Judgement]) -> str:
    counts = [f"{sum(judgement.verdict is verdict for judgement in judgements)} {verdict}" for verdict in Verdict]
    return f"Claims, policy by policy: {', '.join(counts)}."
