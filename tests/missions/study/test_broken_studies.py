"""Broken study files, each with every line that `swarm study` has to say about it."""

from __future__ import annotations

from pathlib import Path

import pytest

from missions.problems import MissionError
from missions.study.load import bundled_studies, load_study

TOP = "name, description, mission, set, sweep, policies, faults, runs, seed, figures, claims"
START = "name: s\nmission: quickstart\n"
COMPARE = "either value, or some of than, than_metric, than_from_s and than_until_s"

# What the file holds, and the lines expected, without the "s.yaml" that each begins with.
CASES: dict[str, tuple[str, list[str]]] = {
    "a misspelled key": (START + "swep: []\n", [
        f":3: swep: got an unknown key; allowed: {TOP}; did you mean sweep?",
    ]),
    "no mission": ("name: s\n", [": mission: got nothing; allowed: text"]),
    "no runs": (START + "runs: 0\n", [":3: runs: got 0; allowed: a whole number from 1 to 1000000"]),
    "an axis that is a number": (START + "sweep:\n  - {agents.count: 3}\n", [
        ":4: sweep.0.agents.count: got 3; allowed: a list of axes, such as [{agents.count: [5, 10]}]",
    ]),
    "an axis without values": (START + "sweep:\n  - {agents.count: []}\n", [
        ":4: sweep.0.agents.count: got no values; allowed: at least one value",
    ]),
    "keys out of step": (START + "sweep:\n  - agents.count: [5, 10]\n    targets.count: [5]\n", [
        ":5: sweep.0.targets.count: got 1 value; "
        "allowed: 2, as many as agents.count has: keys of one axis go in step",
    ]),
    "a key on two axes": (START + "sweep:\n  - {agents.count: [5]}\n  - {agents.count: [6]}\n", [
        ":5: sweep.1.agents.count: got a second axis (the first is sweep.0); allowed: each key on one axis",
    ]),
    "a swept seed": (START + "sweep:\n  - {seed: [5]}\n", [
        ":4: sweep.0.seed: got a key that every study varies; allowed: the study's policies, runs and seed",
    ]),
    "a policy's name": (START + "policies: {a b: {}}\n", [
        ":3: policies.a b: got \"a b\"; allowed: a word of letters, digits, '_', '.' and '-', at most 64 long, "
        "that starts with a letter or digit",
    ]),
    "the last seed": (START + "seed: 4294967290\nruns: 10\n", [
        ":3: seed: got 4294967290; allowed: at most 4294967286, so that the last run has a seed",
    ]),
    "figures": (START + "figures:\n  - {name: f, x: tme}\n  - {name: f, y: calls}\n  - {nam: f}\n", [
        ":6: figures.2.name: got nothing; allowed: a word of letters, digits, '_', '.' and '-', at most 64 long, "
        "that starts with a letter or digit",
        ":6: figures.2.nam: got an unknown key; allowed: name, title, x, y, where, until_s, x_label, paper; "
        "did you mean name?",
    ]),
    "figures of nothing": (START + "figures:\n  - {name: f, x: tme}\n  - {name: f, y: calls}\n", [
        ':4: figures.0.x: got "tme"; allowed: time, ratio, agents or targets; did you mean time?',
        ':5: figures.1.name: got "f"; allowed: a name that no other figure has',
        ':5: figures.1.y: got "calls"; allowed: coverage or utilization where x is time',
    ]),
    "an axis of words": (
        START + "sweep: [{policy.explore: [stale-first]}]\nfigures:\n  - {name: f, x: policy.explore}\n",
        [':5: figures.0.x: got "policy.explore", whose values are no numbers; allowed: a key swept over numbers'],
    ),
    "a figure of what is not flown": (
        START + "sweep: [{agents.count: [5, 6]}]\nfigures:\n  - {name: f, where: {agents.count: 7, agent: 1}}\n",
        [
            ":5: figures.0.where.agents.count: got 7; allowed: 5 or 6",
            ":5: figures.0.where.agent: got a key that is not varied; "
            "allowed: agents.count, ratio, agents, targets or policy; did you mean agents?",
        ],
    ),
    "claims that compare nothing": (
        START + "claims:\n  - paper: x\n    figure: y\n    checks:\n      - {}\n      - {value: 1, than: {}}\n"
        "      - {value: 1, from_s: 9, until_s: 5}\n      - {expect: closer, than: {}}\n",
        [
            f":7: claims.0.checks.0: got nothing to compare with; allowed: {COMPARE}",
            f":8: claims.0.checks.1: got two things to compare with; allowed: {COMPARE}",
            ":9: claims.0.checks.2.until_s: got 5; allowed: more than from_s (9)",
            ":10: claims.0.checks.3: got closer without than or its window; "
            "allowed: than, than_from_s and than_until_s with closer",
        ],
    ),
    "a claim about several points at once": (
        START + "sweep:\n  - agents.count: [5, 5, 6]\n    targets.count: [7, 8, 9]\n"
        "claims:\n  - paper: x\n    figure: y\n    checks:\n      - {of: {agents: 6}, than: {agents.count: 5}}\n",
        [":10: claims.0.checks.0.than: got what fits 2 points; allowed: what fits one point"],
    ),
    # Mistakes of the missions are blamed on the study's lines.
    "keys of the mission": (
        START + "set: {agents.sensing.rang_m: 3}\nsweep:\n  - agents.count: [5, 0]\n"
        "policies:\n  a: {commitment: maybe}\n",
        [
            ":3: agents.sensing.rang_m: got an unknown key; allowed: range_m, field_of_view, opening_deg, "
            "half_angle_deg, identity_error; did you mean range_m?",
            ":5: agents.count: got 0; allowed: a whole number from 1 to 1000",
            ':7: policy.commitment: got "maybe"; allowed: true or false',
        ],
    ),
    "rules of the mission": (START + "set: {radio.range_m: 8}\nsweep:\n  - agents.sensing.range_m: [7, 9]\n", [
        ":3: radio.range_m: got 8; allowed: more than agents.sensing.range_m (9)",
    ]),
    "no such mission": ("name: s\nmission: quickstrt\n", [
        ":2: mission: got no such mission; allowed: the path of a mission file, or a bundled mission "
        "(baboons, crowded, faults, narrow, quickstart, reference, tracks, wildlife); did you mean quickstart?",
    ]),
}  # fmt: skip


@pytest.mark.parametrize("case", CASES)
def test_says_all_that_is_wrong(case: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text, expected = CASES[case]
    monkeypatch.chdir(tmp_path)
    Path("s.yaml").write_text(text, encoding="utf-8")
    with pytest.raises(MissionError) as caught:
        load_study("s.yaml")
    assert str(caught.value).splitlines() == [f"s.yaml{line}" for line in expected]


def test_an_unknown_study_lists_the_bundled_ones() -> None:
    with pytest.raises(MissionError) as caught:
        load_study("figure-61")
    allowed = f"the path of a study file, or a bundled study ({', '.join(bundled_studies())})"
    assert str(caught.value).startswith(f"figure-61: got no such study; allowed: {allowed}; did you mean figure-1")
