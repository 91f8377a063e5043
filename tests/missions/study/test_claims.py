"""Claims against runs whose numbers are known: what is confirmed, refuted and open, and in which words."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from missions.study.claims import Judgement, Verdict, judged
from missions.study.flown import Flown
from missions.study.load import ReadyStudy, load_study
from missions.study.pages import claims_table
from missions.study.results import Results

HEAD = """name: known
mission: quickstart
set: {duration_s: 4}
sweep: [{agents.count: [5, 10]}]
policies: {a: {}, b: {predictor: none}}
runs: 4
claims:
  - paper: It is so.
    figure: figure 1
    checks:
"""
# Coverage of each run in each of four seconds, by agents and policy.
COVERAGE = {
    (5, "a"): [[0.8, 0.6, 0.7, 0.5], [0.9, 0.6, 0.7, 0.6], [0.8, 0.5, 0.7, 0.6], [0.9, 0.5, 0.7, 0.5]],
    (5, "b"): [[0.6, 0.5, 0.5, 0.4], [0.7, 0.5, 0.5, 0.5], [0.6, 0.4, 0.5, 0.5], [0.7, 0.4, 0.5, 0.4]],
    (10, "a"): [[1.0, 0.9, 0.8, 0.6], [1.0, 0.9, 0.8, 0.6], [1.0, 0.9, 0.8, 0.6], [1.0, 0.9, 0.8, 0.6]],
    (10, "b"): [[1.0, 0.9, 0.7, 0.6], [1.0, 0.9, 0.9, 0.6], [1.0, 0.9, 0.7, 0.6], [1.0, 0.9, 0.9, 0.6]],
}


def flown(ready: ReadyStudy) -> dict[str, Flown]:
    runs = {}
    for point in ready.points:
        values = point.values
        seen = np.rint(np.array(COVERAGE[values["agents.count"], values["policy"]]) * 100).astype(np.int64)
        present = np.full_like(seen, 100)
        zeros = np.zeros((4, 7), dtype=np.int64)
        runs[point.digest] = Flown(np.arange(1, 5), seen, present, zeros, seen[:, -1] / 100, values["agents.count"], 10)
    return runs


def judge(tmp_path: Path, *checks: str, policies: tuple[str, ...] = ()) -> list[Judgement]:
    path = tmp_path / "known.yaml"
    path.write_text(HEAD + "".join(f"      - {check}\n" for check in checks))
    ready = load_study(str(path), policies=policies)
    return judged(Results(ready, flown(ready)))


@pytest.mark.parametrize(
    ("check", "verdict"),
    [
        # Compared seed by seed: a is above b by .15 and .175 in turn, whatever the runs differ among themselves.
        ("{of: {policy: a, agents.count: 5}, than: {policy: b}}", Verdict.CONFIRMED),
        ("{of: {policy: b, agents.count: 5}, than: {policy: a}}", Verdict.REFUTED),
        ("{of: {policy: a, agents.count: 5}, than: {policy: b}, within: 0.15}", Verdict.OPEN),
        ("{of: {policy: a, agents.count: 5}, expect: below, than: {policy: b}}", Verdict.REFUTED),
        # Ten agents: the mean is the same, the runs are not.
        ("{of: {policy: a, agents.count: 10}, than: {policy: b}}", Verdict.OPEN),
        ("{of: {policy: a, agents.count: 10}, expect: insignificant, than: {policy: b}}", Verdict.CONFIRMED),
        ("{of: {policy: a, agents.count: 5}, expect: insignificant, than: {policy: b}}", Verdict.REFUTED),
        ("{of: {policy: a, agents.count: 10}, expect: about, within: 0.1, than: {policy: b}}", Verdict.CONFIRMED),
        ("{of: {policy: a, agents.count: 10}, expect: about, within: 0.001, than: {policy: b}}", Verdict.OPEN),
        # With a number.
        ("{of: {policy: a, agents.count: 10}, expect: about, value: 0.8, within: 0.03}", Verdict.CONFIRMED),
        ("{of: {policy: a, agents.count: 10}, expect: about, value: 0.7, within: 0.03}", Verdict.REFUTED),
        ("{of: {policy: a, agents.count: 10}, until_s: 2, expect: above, value: 0.94}", Verdict.CONFIRMED),
        ("{metric: lowest, of: {policy: a, agents.count: 10}, expect: below, value: 0.6}", Verdict.REFUTED),
        # With the same point at another time, or another of its numbers.
        ("{of: {policy: a, agents.count: 10}, from_s: 3, expect: below, than_from_s: 0, than_until_s: 1}",
         Verdict.CONFIRMED),
        ("{of: {policy: a, agents.count: 10}, from_s: 2, until_s: 3, than_metric: lowest}", Verdict.CONFIRMED),
        # Five and ten agents are .2 to .3 apart in the second second, .1 to 0 in the last.
        ("{of: {policy: a, agents.count: 10}, from_s: 3, until_s: 4, expect: closer, than: {agents.count: 5}, "
         "than_from_s: 1, than_until_s: 2}", Verdict.CONFIRMED),
        ("{of: {policy: a, agents.count: 10}, from_s: 1, until_s: 2, expect: closer, than: {agents.count: 5}, "
         "than_from_s: 3, than_until_s: 4}", Verdict.REFUTED),
    ],
)  # fmt: skip
def test_the_interval_decides(check: str, verdict: Verdict, tmp_path: Path) -> None:
    (judgement,) = judge(tmp_path, check)
    assert judgement.verdict is verdict
    assert judgement.policy is None


def test_words_follow_from_the_numbers(tmp_path: Path) -> None:
    (judgement,) = judge(tmp_path, "{of: {policy: a, agents.count: 10}, from_s: 2, until_s: 3, than: {policy: b}}")
    # b: .7 .9 .7 .9, s = .11547, half = 3.18245 s / 2 = .1837.
    assert [finding.measured for finding in judgement.findings] == [
        "10 agents, a: coverage 2 to 3 s 80.0 % ± 0.0, b 80.0 % ± 18.4: +0.0 ± 18.4 points"
    ]
    assert claims_table([judgement])[2] == (
        "| figure 1 | It is so. | compared | 10 agents, a: coverage 2 to 3 s 80.0 % ± 0.0, b 80.0 % ± 18.4: "
        "+0.0 ± 18.4 points | **? open** |"
    )


def test_a_check_is_made_wherever_it_leaves_things_open(tmp_path: Path) -> None:
    (judgement,) = judge(tmp_path, "{of: {policy: a}, expect: above, than: {policy: b}}")
    assert [finding.verdict for finding in judgement.findings] == [Verdict.CONFIRMED, Verdict.OPEN]
    assert judgement.verdict is Verdict.OPEN


def test_one_refuted_check_refutes_a_claim(tmp_path: Path) -> None:
    (judgement,) = judge(
        tmp_path, "{of: {policy: a}, than: {policy: b}}", "{of: {policy: b, agents.count: 5}, than: {policy: a}}"
    )
    assert judgement.verdict is Verdict.REFUTED


def test_a_claim_about_no_policy_is_judged_for_each(tmp_path: Path) -> None:
    found = judge(tmp_path, "{of: {agents.count: 10}, than: {agents.count: 5}}")
    assert [(judgement.policy, judgement.verdict) for judgement in found] == [
        ("a", Verdict.CONFIRMED), ("b", Verdict.CONFIRMED),
    ]  # fmt: skip


def test_a_claim_about_a_policy_that_was_not_flown_is_left_out(tmp_path: Path) -> None:
    assert judge(tmp_path, "{of: {policy: a}, than: {policy: b}}", policies=("a",)) == []
    assert judge(tmp_path, "{of: {policy: b}, expect: above, value: 0}", policies=("a",)) == []
