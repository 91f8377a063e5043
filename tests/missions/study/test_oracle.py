"""What only a study can know: what will happen, and who should answer which call."""

from __future__ import annotations

from math import sqrt

import pytest

np = pytest.importorskip("numpy")
pytest.importorskip("numba")

from missions import compose  # noqa: E402
from missions.metrics import ANSWERED  # noqa: E402
from missions.study.compiled.foresight import foresee, new_future  # noqa: E402
from missions.study.compiled.state import Setup, new_flock, new_tables  # noqa: E402
from missions.study.engine import fly_many, fly_setup, setup_of  # noqa: E402
from swarm_agent.bcmommt.belief import FAR  # noqa: E402
from tests.missions.study.scenes import mission, replayed  # noqa: E402

FORESEEN = "policy={predictor: perfect, call: predicted, horizon_s: 60, memory_s: 0}"


def foreseen(setup: Setup, *changes: str) -> list[float]:
    """When each target will be lost, seen from the start."""
    params, (m, n) = compose.params(mission(FORESEEN, *changes)), (len(setup.home_x), len(setup.target_x))
    tables = new_tables(m, n, 0)
    foresee(setup, params, new_flock(setup), tables, new_future(m, n), 0)
    assert (tables.loss_in_s == tables.loss_in_s[0]).all()  # all agents are told the same
    return [float(loss) for loss in tables.loss_in_s[0]]


def test_a_pair_that_flees_apart_is_lost_when_it_leaves_the_agents_sight() -> None:
    setup = replayed(
        mission("duration_s=30", "arena.radius_m=300"),
        agents=[(0.0, 0.0)],
        targets=[(-4.0, 0.0), (4.0, 0.0)],
        velocities=[(0.0, -0.3), (0.0, 0.3)],
    )
    assert foreseen(setup) == pytest.approx([sqrt(5.5**2 - 4**2) / 0.3] * 2, abs=0.1)


def test_nobody_with_one_target_loses_it() -> None:
    assert foreseen(setup_of(mission("agents.count=1", "targets.count=1"))) == [FAR]


def test_what_is_foreseen_comes_true_where_nobody_can_help() -> None:
    """One agent over two evasive targets: the first is lost when it was foreseen at the start.

    To two ticks: in its first one the agent does not know yet how fast they are.
    """
    changes = ("agents.count=1", "targets.count=2", "agents.deployment.radius_m=0.5", "targets.deployment.radius_m=1.5")
    for seed in range(1, 21):
        setup = setup_of(mission(*changes, "duration_s=60", f"seed={seed}"))
        kept = fly_setup(setup, compose.params(mission(FORESEEN, *changes)), keep_all=True)
        lost = np.flatnonzero(~kept.sensed.any(axis=1).all(axis=1))
        assert min(foreseen(setup, *changes)) == pytest.approx(0.1 * lost[0], abs=0.21)


def test_an_agent_that_flies_past_counts_as_sight() -> None:
    """Definition 3: a target is lost when nobody sees it, not when its follower does not."""
    alone = {"agents": [(0.0, 0.0)], "targets": [(-4.0, 0.0), (4.0, 0.0)], "velocities": [(0.0, -0.3), (0.0, 0.3)]}
    wide = mission("duration_s=30", "arena.radius_m=300")
    mate = {**alone, "agents": [(0.0, 0.0), (4.0, 6.0)]}
    assert foreseen(replayed(wide, **mate))[1] > foreseen(replayed(wide, **alone))[1] + 10


@pytest.mark.parametrize("answering", ["distributed", "optimal"])
def test_a_referee_sends_helpers_as_agents_send_themselves(answering: str) -> None:
    """With one idle agent and one call there is nothing to assign: both ways keep both targets."""
    policy = f"policy={{call: all_but_nearest, answering: {answering}, help_margin_s: 40, memory_s: 0}}"
    setup = replayed(
        mission("duration_s=30", "arena.radius_m=300"),
        agents=[(0.0, 0.0), (4.0, -6.0)],
        targets=[(-4.0, 0.0), (4.0, 0.0)],
        velocities=[(0.0, -0.3), (0.0, 0.3)],
    )
    kept = fly_setup(setup, compose.params(mission(policy)), keep_all=True)
    assert kept.help[ANSWERED] > 0
    assert kept.sensed.any(axis=1).all()


def test_a_referee_hears_beyond_the_radio() -> None:
    """The idle agent is out of the caller's range: only the referee can send it."""
    far = ("radio.range_m=8", "duration_s=60", "arena.radius_m=300")
    start = {
        "agents": [(0.0, 0.0), (12.0, 0.0)],
        "targets": [(-3.0, 0.0), (3.0, 0.0)],
        "velocities": [(-0.05, 0.0), (0.05, 0.0)],
    }
    answered = {}
    for answering in ("distributed", "optimal"):
        policy = f"policy={{call: all_but_nearest, answering: {answering}, help_margin_s: 40, memory_s: 0}}"
        setup = replayed(mission(*far, "duration_s=1"), **start)
        answered[answering] = fly_setup(setup, compose.params(mission(policy, *far)), keep_all=False).help[ANSWERED]
    assert answered == {"distributed": 0, "optimal": 1}


def test_same_seed_same_runs() -> None:
    ready = mission("policy={predictor: perfect, answering: optimal, call: predicted}", "duration_s=30")
    one, two = (fly_many(ready, seeds=range(1, 4)) for _ in range(2))
    assert (one.seen == two.seen).all()
    assert (one.help == two.help).all()
