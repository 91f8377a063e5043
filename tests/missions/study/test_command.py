"""`swarm study` on the command line: options that reach the study, exit codes, and what it says."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from missions.cli import main
from missions.commands import command as verb
from missions.exit_codes import BAD_INPUT, DONE, STOPPED
from missions.overrides import Override
from missions.study import command
from missions.study.command import StudyOptions
from missions.study.fly import here
from missions.study.load import bundled_studies
from missions.study.shards import Shard
from tests.missions.study.toy_runs import WITHOUT_FIGURES, fly


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, StudyOptions]]:
    """Stands where studies are flown, and notes what it was asked to fly."""
    calls: list[tuple[str, StudyOptions]] = []

    def fly_study(name: str, options: StudyOptions) -> int:
        calls.append((name, options))
        return DONE

    monkeypatch.setattr(command, "fly_study", fly_study)
    monkeypatch.setattr(command, "fly_paper", lambda options: fly_study("paper", options))
    return calls


def test_options_reach_the_study(asked: list[tuple[str, StudyOptions]]) -> None:
    options = ["--runs", "5", "--seed", "0", "--policy", "a", "--policy", "b", "--set", "tick_s=0.2", "--out", "o"]
    more = ["--shard", "2/4", "--dask", "tcp://h:1", "--fresh", "--threads", "2"]
    assert main(["study", "figure-11", *options, *more]) == DONE
    assert asked == [
        (
            "figure-11",
            StudyOptions(
                runs=5, seed=0, policies=("a", "b"), overrides=(Override("tick_s=0.2"),), out=Path("o"),
                shard=Shard(2, 4), dask="tcp://h:1", fresh=True, threads=2,
            ),
        )
    ]  # fmt: skip


def test_paper_is_all_of_them(asked: list[tuple[str, StudyOptions]]) -> None:
    assert main(["study", "paper", "--runs", "5"]) == DONE
    assert asked == [("paper", StudyOptions(runs=5))]


def test_help_names_the_bundled_studies(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["study", "--help"]) == DONE
    text = " ".join(capsys.readouterr().out.split()).replace("- ", "-")
    assert all(name in text for name in bundled_studies())


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["figure-1"], "figure-1: got no such study; allowed: the path of a study file, or a bundled study"),
        (["figure-11", "figure-12"], 'STUDY: got "figure-11 figure-12"; allowed: one study, paper, or merge and'),
        (["merge"], 'STUDY: got "merge"; allowed: one study, paper, or merge and the folders to merge'),
        (["merge", "/no/such"], "/no/such: got no study; allowed: a folder that swarm study has written"),
        (["figure-11", "--runs", "0"], 'argument --runs: got "0"; allowed: a whole number above 0'),
        (["figure-11", "--shard", "3/2"], 'argument --shard: got "3/2"; allowed: i/N with i from 1 to N'),
        (["figure-11", "--policy", "x"], '--policy: got "x"; allowed: basic, printed, default'),
        (["figure-11", "--set", "targets.count=3"], "--set: targets.count: got a key that the study sweeps"),
        (["figure-11", "--set", "tick_s=7"], "--set: tick_s: got 7; allowed: a number from 0.01 to 1"),
        (["figure-11", "--runs", "2000000"], "--runs: runs: got 2000000; allowed: a whole number from 1 to 1000000"),
    ],
)
def test_bad_input_exits_2_and_says_why(
    arguments: list[str], said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["study", *arguments]) == BAD_INPUT
    assert said in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_without_the_extra_it_says_how_to_get_it(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(verb, "find_spec", lambda name: None if name == "numba" else object())
    assert main(["study", "figure-11"]) == BAD_INPUT
    assert capsys.readouterr().err == (
        "swarm study needs the `study` extra: pip install 'swarm-mission-stack[study]' (no module 'numba')\n"
    )


def test_it_is_quiet_away_from_a_terminal(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "toy.yaml").write_text(WITHOUT_FIGURES)
    out = tmp_path / "out"
    assert command.fly_study(str(tmp_path / "toy.yaml"), StudyOptions(out=out), flyer=here(fly)) == DONE
    printed = capfd.readouterr()
    assert (printed.out, printed.err) == ("", f"{out / 'index.md'}{os.linesep}")


def test_ctrl_c_is_130(monkeypatch: pytest.MonkeyPatch) -> None:
    def fly_study(name: str, options: StudyOptions) -> int:
        raise KeyboardInterrupt

    monkeypatch.setattr(command, "fly_study", fly_study)
    assert main(["study", "figure-11"]) == STOPPED
