"""The tutorial on reviews does what it says: its commands run, and print what it shows."""

from __future__ import annotations

import shlex
from pathlib import Path

import pytest

from missions.cli import main
from tests.docs.console import commands, matches
from tests.docs.tutorial_recording import RECORDING

PAGE = Path(__file__).parents[2] / "docs" / "reviewing.md"


def test_the_tutorial_shows_what_its_commands_print(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "docs").symlink_to(PAGE.parent)
    monkeypatch.chdir(tmp_path)
    ran = 0
    for command in commands(PAGE.read_text(encoding="utf-8")):
        program, *arguments = shlex.split(command.text)
        assert program == "swarm"
        capsys.readouterr()
        assert main(arguments) == command.code, command.text
        printed = capsys.readouterr().out
        assert matches(command.shown, printed), f"{command.text}\n{printed}"
        ran += 1
    assert ran >= 10


def test_the_bundled_recording_is_small() -> None:
    assert RECORDING.stat().st_size < 300_000


@pytest.mark.parametrize(
    ("shown", "printed", "fits"),
    [
        (("a", "b"), "a\nb  \n", True),
        (("a", "b"), "a\nc\n", False),
        (("a", "...", "d"), "a\nb\nc\nd\n", True),
        (("a", "...", "d"), "a\nd\n", True),
        (("a", "...", "d"), "a\nb\n", False),
        (("a", "..."), "b\na\n", False),
        (("V1, ... in ...",), "V1, 12 messages in 3 s\n", True),
    ],
)
def test_what_fits_a_page(shown: tuple[str, ...], printed: str, fits: bool) -> None:
    assert matches(shown, printed) is fits
