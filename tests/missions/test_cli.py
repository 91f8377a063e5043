"""The command line: help, exit codes, options that reach the mission, and what a verb does not import."""

from __future__ import annotations

import json
import subprocess
import sys
from math import inf
from pathlib import Path
from types import ModuleType

import pytest

from missions.cli import main
from missions.daemons.options import ENDPOINT
from missions.exit_codes import BAD_INPUT, DONE, FAILED, STOPPED
from missions.load import load_mission
from missions.mission import Mission
from missions.options import Board, LaunchOptions
from missions.overrides import Override
from missions.schema import mission_schema

VERBS = ("launch", "world", "agent", "record", "status", "hold", "keys", "check", "plan", "schema", "sim", "study")


@pytest.mark.parametrize("verb", VERBS)
def test_help_fits_a_screen_and_has_an_example(verb: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([verb, "--help"]) == DONE
    text = capsys.readouterr().out
    assert f"usage: swarm {verb}" in text
    assert f"\n  swarm {verb} " in text or f"\n  swarm {verb}\n" in text
    assert len(text.splitlines()) <= 40
    assert max(map(len, text.splitlines())) <= 120


def test_help_names_every_verb_and_exit_code(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--help"]) == DONE
    text = capsys.readouterr().out
    assert all(f"\n    {verb} " in text for verb in VERBS)
    assert "0 done, 1 the mission failed, 2 bad input, 130 stopped by Ctrl-C" in text
    assert len(text.splitlines()) <= 40


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["fly"],
        ["check"],
        ["launch"],
        ["launch", "quickstart", "--speed", "0"],
        ["launch", "quickstart", "--speed", "fast"],
        ["launch", "quickstart", "--speed", "nan"],
        ["launch", "quickstart", "--record", "/no/such/folder/f.rrd"],
        ["launch", "quickstart", "--report", "/"],
        ["launch", "no-such-mission"],
        ["plan", "quickstart", "--seed", "-1"],
        ["plan", "quickstart", "--set", "agents"],
    ],
)
def test_bad_input_exits_2_and_says_why(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(arguments) == BAD_INPUT
    printed = capsys.readouterr()
    assert printed.out == ""
    assert printed.err != ""


def test_seed_and_duration_are_overrides_by_another_name(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plan", "narrow", "--seed", "many", "--duration=-1"]) == BAD_INPUT
    assert capsys.readouterr().err.splitlines() == [
        '--seed: seed: got "many"; allowed: a whole number from 0 to 4294967295',
        "--duration: duration_s: got -1; allowed: a number above 0",
    ]
    assert main(["plan", "narrow", "--seed", "5", "--duration", "60"]) == DONE
    short = capsys.readouterr().out
    assert main(["plan", "narrow", "--set", "seed=5", "--set", "duration_s=60"]) == DONE
    assert capsys.readouterr().out == short


def test_check_says_ok(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "wildlife", "tracks"]) == DONE
    printed = capsys.readouterr()
    assert printed.out == "wildlife: ok (10 agents, evasive targets)\ntracks: ok (6 agents, tracks targets)\n"
    assert printed.err == ""


def test_check_takes_overrides_and_reads_the_tracks(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    tracks = tmp_path / "tracks.csv"
    tracks.write_text("t,id,x,y\n0,a,0,0\n9,a,1,1\n")
    assert main(["check", "baboons", "--set", f"targets.file={tracks}"]) == DONE
    assert capsys.readouterr().out == "baboons: ok (8 agents, tracks targets)\n"
    tracks.write_text("t,id,x,y\n0,a,0,zz\n")
    assert main(["check", "baboons", "--set", f"targets.file={tracks}"]) == BAD_INPUT
    assert "y is 'zz'" in capsys.readouterr().err


def test_schema_prints_the_schema(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["schema"]) == DONE
    assert json.loads(capsys.readouterr().out) == mission_schema()


class Launches:
    """Stands where missions are flown, and notes what it was asked to fly."""

    def __init__(self, outcome: int | BaseException = DONE) -> None:
        self.outcome = outcome
        self.asked: list[tuple[Mission, LaunchOptions]] = []

    def launch(self, mission: Mission, *, options: LaunchOptions) -> int:
        self.asked.append((mission, options))
        if isinstance(self.outcome, BaseException):
            raise self.outcome
        return self.outcome


def stand_in(monkeypatch: pytest.MonkeyPatch, outcome: int | BaseException = DONE) -> Launches:
    launches, module = Launches(outcome), ModuleType("missions.launch")
    vars(module)["launch"] = launches.launch
    monkeypatch.setitem(sys.modules, "missions.launch", module)
    return launches


def test_launch_passes_the_mission_and_its_options(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    launches = stand_in(monkeypatch)
    record, report = tmp_path / "f.rrd", tmp_path / "f.json"
    options = ["--speed", "2.5", "--record", str(record), "--report", str(report), "--view"]
    assert main(["launch", "narrow", "--seed", "9", "--set", "agents.count=3", *options]) == DONE
    expected = load_mission("narrow", overrides=[Override("seed=9"), Override("agents.count=3")])
    launched = LaunchOptions(speed=2.5, record=record, report=str(report), view=True, board=Board(endpoint=ENDPOINT))
    assert launches.asked == [(expected, launched)]


@pytest.mark.parametrize("speed", [[], ["--speed", "max"]])
def test_launch_goes_as_fast_as_it_can_unless_told(speed: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    launches = stand_in(monkeypatch)
    assert main(["launch", "narrow", *speed, "--report", "-"]) == DONE
    assert launches.asked[0][1] == LaunchOptions(speed=inf, record=None, report="-", view=False)


@pytest.mark.parametrize(("outcome", "code"), [(FAILED, FAILED), (STOPPED, STOPPED), (KeyboardInterrupt(), STOPPED)])
def test_the_exit_code_is_the_missions(
    outcome: int | BaseException, code: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    stand_in(monkeypatch, outcome)
    assert main(["launch", "narrow"]) == code


HEAVY = ("zenoh", "pymavlink", "rerun", "numpy", "torch", "numba")


@pytest.mark.parametrize(
    "arguments",
    [
        ["check", "quickstart"],
        ["plan", "quickstart"],
        ["plan", "quickstart", "--processes"],
        ["schema"],
        ["launch", "nil"],
    ],
)
def test_looking_at_a_mission_imports_nothing_heavy(arguments: list[str]) -> None:
    program = (
        "import sys\nfrom missions.cli import main\n"
        f"main({arguments!r})\n"
        f"print([name for name in {HEAVY!r} if name in sys.modules], file=sys.stderr)\n"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True, timeout=60)
    assert done.stderr.splitlines()[-1] == "[]"
