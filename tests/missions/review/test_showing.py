"""What a review prints and writes: pages, pictures, moments, comparisons; and what it refuses."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
from html.parser import HTMLParser
from math import inf
from pathlib import Path
from urllib.request import urlopen
from xml.etree import ElementTree

import pytest

from missions.cli import main
from missions.launch import recorder_of
from missions.load import load_mission
from missions.options import LaunchOptions
from missions.recording.playback import play_back
from missions.review.comparison import parting_s
from missions.review.reading import read
from missions.review.words import clock, clock_s
from tests.missions.review.conftest import FLOWN, Flown
from tests.patience import PATIENCE_S, until


def _told(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    capsys.readouterr()
    assert main(["review", *arguments]) == 0
    return capsys.readouterr().out


def test_the_summary_has_the_numbers_of_the_report(flown: Flown, capsys: pytest.CaptureFixture[str]) -> None:
    told = _told(capsys, str(flown.recording))
    assert f"{100 * flown.report['coverage']:.1f} %" in told
    assert f"{flown.report['help']['calls']} calls" in told
    assert ", complete" in told
    assert told.count("any more") == min(12, len(flown.review.losses))


def test_a_line_of_the_timeline_reads_when_who_doing_what(flown: Flown, capsys: pytest.CaptureFixture[str]) -> None:
    main_lines = _told(capsys, str(flown.recording), "--events").splitlines()
    assert all(re.match(r" *\d+:\d\d\.\d  (A\d+|mission) ", line) for line in main_lines)
    assert any(re.search(r"A\d+ +CALLING FOR HELP +calls for help: T\d+", line) for line in main_lines)
    everything = _told(capsys, str(flown.recording), "--events", "all").splitlines()
    assert {*main_lines} < {*everything}
    assert any("PREPARING" in line and "EKF3" in line for line in everything)


def test_a_moment_tells_what_an_agent_followed_knew_and_wanted(
    flown: Flown, capsys: pytest.CaptureFixture[str]
) -> None:
    with play_back(flown.recording) as playback:
        observations = list(playback.observations())
    seen = next(seen for seen in observations if any(status.tags for status in seen.statuses))
    status = next(status for status in seen.statuses if status.tags)
    told = _told(capsys, str(flown.recording), "--at", clock(seen.time_s + 2.0), "--agent", str(status.uid))
    now = next(one for one in observations if one.time_s > seen.time_s + 1.99).statuses[status.uid]
    assert told.startswith(f"A{status.uid} at {clock(seen.time_s + 2.0)}: {now.activity.value}")
    assert all(f"T{number} (" in told for number in now.tags)
    assert "What it knew and wanted" in told


_LOADED = frozenset({"src", "href", "xlink:href", "srcset", "data"})


class _Sources(HTMLParser):
    """Whatever a page would load."""

    def __init__(self) -> None:
        super().__init__()
        self.sources: list[str] = []
        self.pictures = 0  # that have words for those who do not see them

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.sources += [value or "" for name, value in attrs if name in _LOADED]
        self.pictures += tag == "svg" and bool(dict(attrs).get("aria-label"))


def test_the_page_holds_all_of_its_pictures_and_loads_nothing(flown: Flown, tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    assert main(["review", str(flown.recording), "--report", str(page)]) == 0
    text = page.read_text()
    parser = _Sources()
    parser.feed(text)
    assert all(source.startswith("#") for source in parser.sources), "only parts of the page itself"
    assert all(place.startswith("#") for place in re.findall(r"url\(([^)]*)", text))
    assert parser.pictures == 2
    assert "@import" not in text
    assert f"{100 * flown.report['coverage']:.1f} %" in text
    assert "$" not in text
    assert len(text) < 400_000


def test_pictures_are_png_or_svg_and_repeat_exactly(flown: Flown, tmp_path: Path) -> None:
    for name in ("one.png", "two.png", "one.svg", "two.svg"):
        assert main(["review", str(flown.recording), "--plot", str(tmp_path / name)]) == 0
    for kind in ("png", "svg"):
        assert (tmp_path / f"one.{kind}").read_bytes() == (tmp_path / f"two.{kind}").read_bytes()
    assert (tmp_path / "one.png").read_bytes().startswith(b"\x89PNG")
    assert ElementTree.parse(tmp_path / "one.svg").getroot().tag.endswith("svg")


def test_a_single_tick_is_drawn(flown: Flown, tmp_path: Path) -> None:
    with play_back(flown.recording) as playback:
        first = next(playback.observations())
    record = LaunchOptions(speed=inf, record=tmp_path / "tick.rrd")
    with recorder_of(load_mission("quickstart"), len(first.targets), record) as recorder:
        recorder.observe(first)
    told = ["--plot", str(tmp_path / "tick.svg"), "--report", str(tmp_path / "tick.html")]
    assert main(["review", str(tmp_path / "tick.rrd"), *told]) == 0
    assert "From each target to the nearest agent" in (tmp_path / "tick.html").read_text()
    assert ElementTree.parse(tmp_path / "tick.svg").getroot().tag.endswith("svg")


def test_beside_json_words_go_where_people_look(flown: Flown, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["review", str(flown.recording), "--json", "--check", "coverage > 0"]) == 0
    told = capsys.readouterr()
    assert json.loads(told.out)["coverage"] > 0
    assert "holds: coverage > 0" in told.err


def test_it_is_told_which_of_two_recordings_fails_a_check(flown: Flown, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["review", str(flown.recording), str(flown.recording), "--check", "coverage > 2"]) == 1
    assert capsys.readouterr().out.count(f"{flown.recording.name}: FAILS: coverage > 2") == 2


def test_missions_at_other_places_are_not_the_same(
    flown: Flown, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    short = ["launch", "narrow", "--duration", "2", "--set", "agents.count=1", "--set", "targets.count=1"]
    for name, speed in (("slow", ".1"), ("fast", ".3")):
        given = ["--set", f"targets.speed_m_s={speed}", "--record", str(tmp_path / f"{name}.rrd")]
        assert main([*short, *given]) == 0
    told = _told(capsys, str(tmp_path / "slow.rrd"), str(tmp_path / "fast.rrd"))
    assert told.startswith("Everybody does the same in both missions, at other places.")


def test_two_missions_are_held_against_each_other(
    flown: Flown, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    other = tmp_path / "other.rrd"
    assert main([*FLOWN, "--set", "policy.explore=stale-first", "--record", str(other)]) == 0
    told = _told(capsys, str(flown.recording), str(other))
    assert "The two missions part at" in told
    assert re.search(r"policy\.explore +persistent-walk +stale-first", told)
    assert "seed" not in told
    assert f"{100 * flown.report['coverage']:.1f} %" in told
    assert _told(capsys, str(flown.recording), str(flown.recording)).startswith("The two missions are the same")
    assert parting_s(flown.review, read(other)) == pytest.approx(clock_s(told.split()[5].rstrip(".")), abs=0.06)
    assert main(["review", str(flown.recording), str(other), "--plot", str(tmp_path / "two.png")]) == 0


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--at", "2:31"], "--at: got no --agent"),
        (["--agent", "4"], "--agent: got no --at"),
        (["--at", "0:30", "--agent", "99"], "--agent: got 99; allowed: 0 to 9"),
        (["--at", "99:00", "--agent", "1"], "--at: got 99:00.0; allowed: 0:00.0 to"),
        (["--at", "soon", "--agent", "1"], "allowed: minutes and seconds"),
        (["--plot", "picture.jpg"], "allowed: a file that ends with .png or .svg"),
        (["--plot", "/nowhere/picture.png"], "allowed: a file that can be written"),
        (["--report", "/nowhere/page.html"], "allowed: a file that can be written"),
        (["--report", "flown.rrd"], "allowed: a file that ends with .html or .htm"),
        (["--check", "coverage > nan"], "--check: got"),
        (["--check", "timing.wall_s < 100"], "--check: got"),
        (["b.rrd", "c.rrd"], "got 3 recordings; allowed: one, or two to compare"),
        (["b.rrd", "--events"], "--events: got 2 recordings; allowed: one"),
    ],
)
def test_bad_questions_say_what_is_allowed(
    flown: Flown, arguments: list[str], told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    at = len(arguments) if "--events" not in arguments else 0
    assert main(["review", *arguments[:at], str(flown.recording), *arguments[at:]]) == 2
    assert told in capsys.readouterr().err


@pytest.mark.parametrize(
    ("time_s", "words"), [(0.0, "0:00.0"), (59.96, "1:00.0"), (151.4, "2:31.4"), (6000.0, "100:00.0")]
)
def test_clock_times(time_s: float, words: str) -> None:
    assert clock(time_s) == words
    assert clock_s(words) == pytest.approx(time_s, abs=0.05)


def test_without_a_screen_there_is_no_window(
    flown: Flown, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"):
        monkeypatch.delenv(name, raising=False)
    assert main(["review", str(flown.recording), "--view"]) == 2
    assert "--view: got no window" in capsys.readouterr().err
    assert main(["review", str(flown.recording), "--view", "--web"]) == 2


def test_a_recording_is_served_to_browsers_until_ctrl_c(flown: Flown) -> None:
    command = [sys.executable, "-u", "-m", "missions.cli", "review", str(flown.recording), "--web"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            url = next(line.split()[-1] for line in process.stdout if line.startswith("Look at it in a browser: "))
            assert url.startswith("http://127.0.0.1:")
            until(lambda: _answers(url))
            process.send_signal(signal.SIGINT)
            assert process.wait(PATIENCE_S) == 0
        finally:
            process.kill()
    assert not _answers(url)


def _answers(url: str) -> bool:
    try:
        with urlopen(url, timeout=5.0) as answer:
            return b"Rerun" in answer.read()
    except OSError:
        return False
