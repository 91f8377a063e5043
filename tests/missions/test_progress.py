"""What a terminal shows while a mission is flown, and what a log file gets."""

from __future__ import annotations

from dataclasses import replace
from io import StringIO

import pytest
from rich.color import Color
from rich.console import Console

from comms.status import Activity
from missions.colors import ACTIVITY_COLORS, hex_color
from missions.metrics import Metrics
from missions.observation import Phase
from missions.panel import Vitals, line_of, panel_of
from missions.progress import Pulse, progress_on
from tests.missions.toy_observations import PREPARATION, toy_observations, toy_scene

VITALS = Vitals(
    title="quickstart, seed 1",
    phase=Phase.MISSION,
    done_s=151.0,
    duration_s=240.0,
    activities=[Activity.FOLLOW] * 7 + [Activity.CALLING, Activity.HELPING, Activity.EXPLORE],
    seen=9,
    present=10,
    coverage=0.912,
    history=[0.0, None, 0.5, 1.0],
    losses=3,
    calls=1,
    helpers=2,
    faults=0,
    realtime_factor=31.4,
    left_s=3.2,
    late_s=0.0,
)


def _drawn(vitals: Vitals, *, width: int = 100) -> Console:
    console = Console(file=StringIO(), width=width, record=True, force_terminal=True, color_system="truecolor")
    console.print(panel_of(vitals))
    return console


def test_the_panel_says_it_all() -> None:
    text = _drawn(VITALS).export_text()
    for words in ("2:31 of 4:00", "0:03 left", "91.2% so far", "7 follow", "9 of 10 seen", "3 lost so far"):
        assert words in text
    assert "1 called for   2 helping" in text
    assert "31.4 × real time" in text
    assert "▁ ▅█" in text


def test_activities_have_the_colors_of_the_recording() -> None:
    page = _drawn(VITALS).export_html()
    for activity in {*VITALS.activities}:
        color = Color.parse(hex_color(ACTIVITY_COLORS[activity])).get_truecolor().hex
        assert f"color: {color}" in page.lower()


@pytest.mark.parametrize("agents", [1, 3, 100, 255])
@pytest.mark.parametrize("width", [20, 84, 200])
def test_any_swarm_fits_any_terminal(agents: int, width: int) -> None:
    vitals = replace(VITALS, activities=[*Activity][:1] + [Activity.FOLLOW] * (agents - 1))
    lines = _drawn(vitals, width=width).export_text().splitlines()
    assert max(map(len, lines)) <= width


@pytest.mark.parametrize("phase", [*Phase])
def test_nothing_known_yet_is_no_error(phase: Phase) -> None:
    bare = replace(VITALS, phase=phase, done_s=0.0, coverage=None, history=[], realtime_factor=None, left_s=None)
    assert "–" in _drawn(bare).export_text()
    assert line_of(bare).startswith(phase.value)


def test_the_time_left_is_told_from_the_pace_so_far() -> None:
    wall_s = [0.0]
    metrics, scene = Metrics(), toy_scene()
    pulse = Pulse(title="toy", duration_s=60.0, tick_s=0.1, metrics=metrics, wall_s=lambda: wall_s[0])
    for seen in toy_observations(scene, ticks=PREPARATION + 300):
        metrics.observe(seen)
        pulse.observe(seen)
        wall_s[0] += 0.01  # ten times real time
    vitals = pulse.vitals(seen)
    assert vitals.done_s == pytest.approx(30.0)
    assert vitals.left_s == pytest.approx(3.0, rel=0.02)
    assert vitals.realtime_factor == pytest.approx(10.0, rel=0.02)
    assert vitals.losses == metrics.events.target_loss
    assert len(vitals.history) == 20


def test_a_log_file_gets_plain_lines_now_and_then() -> None:
    out, metrics = StringIO(), Metrics()
    console = Console(file=out, width=80)
    with progress_on(console, title="toy", duration_s=60.0, tick_s=0.1, metrics=metrics) as progress:
        for seen in toy_observations(toy_scene(), ticks=PREPARATION + 600):
            metrics.observe(seen)
            progress.observe(seen)
    lines = out.getvalue().splitlines()
    assert [line.split(":")[0] for line in lines] == ["prepare", *["mission"] * 9]
    assert "\x1b" not in out.getvalue()
    assert "1:00 of 1:00" in lines[-1]
