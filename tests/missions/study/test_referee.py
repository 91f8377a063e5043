"""The agents' tagging against definitions 2 to 7 of the paper, computed by brute force from the truth."""

from __future__ import annotations

import pytest

np = pytest.importorskip("numpy")
pytest.importorskip("numba")

from missions.study.engine import Trace, trace  # noqa: E402
from tests.missions.study import referee  # noqa: E402
from tests.missions.study.scenes import AS_PRINTED, mission  # noqa: E402

RANGE_M = 5.5
NARROW = ("agents.deployment.radius_m=5", "targets.deployment.radius_m=5")
MISSIONS = {
    "default": (),
    "as printed": (AS_PRINTED,),
    "narrow": NARROW,
    "crowded": (*NARROW, "targets.count=40"),
    "just enough radio": ("radio.range_m=11",),
}


def graph(kept: Trace) -> referee.Floats:
    return referee.environment(kept.agents, kept.targets, sensing_range_m=RANGE_M)


def test_by_hand() -> None:
    agents = np.array([[(0.0, 0.0), (4.0, 0.0)]] * 3)
    targets = np.array([[(1.0, 0.0), (9.0, 0.0)], [(3.0, 0.0), (9.5, 0.0)], [(2.0, 0.0), (9.6, 0.0)]])
    weights = referee.environment(agents, targets, sensing_range_m=RANGE_M)
    assert weights[:, 0].tolist() == [[1.0, np.inf], [3.0, np.inf], [2.0, np.inf]]
    assert weights[:, 1].tolist() == [[3.0, 5.0], [1.0, 5.5], [2.0, np.inf]]
    tags = referee.tagging(weights)
    # Halfway between two agents nobody is nearer: definition 3 leaves that target untagged.
    assert tags[:, 0].tolist() == [[True, False], [False, False], [False, False]]
    assert tags[:, 1].tolist() == [[False, True], [True, True], [False, False]]
    assert referee.distance_vector(weights, tags).tolist() == [[1.0, 5.0], [1.0, 5.5], [0.0, 0.0]]
    assert referee.time_of_loss(weights, tags, tick_s=0.5)[:, 1, 1].tolist() == [1.0, 0.5, np.inf]
    assert referee.events(tags).tolist() == [[0, 2, 0], [0, 0, 1], [2, 0, 0]]


@pytest.mark.parametrize("changes", MISSIONS.values(), ids=MISSIONS)
def test_agents_tag_as_the_definitions_say(changes: tuple[str, ...]) -> None:
    kept = trace(mission(*changes), seed=1)
    weights = graph(kept)
    assert np.array_equal(np.isfinite(weights), kept.sensed)
    # Column by column: a claim is heard one tick late, and a helper on its way leaves safe targets alone (4.2.2).
    agree = (referee.tagging(weights) == kept.tagged).all(axis=1)
    assert agree.mean() > 0.98
    assert np.array_equal(referee.events(kept.tagged).sum(axis=0), kept.events)


@pytest.mark.parametrize("changes", MISSIONS.values(), ids=MISSIONS)
def test_two_agents_tag_one_target_for_one_tick_at_most(changes: tuple[str, ...]) -> None:
    """With r_c >= 2 r_s all who sense a target hear each other: a column's sum is 1 at most once frames are in."""
    double = trace(mission(*changes), seed=1).tagged.sum(axis=1) > 1
    assert double.any()  # when a target changes hands
    assert referee.longest(double) == 1


def test_with_less_radio_two_agents_may_tag_one_target_for_long() -> None:
    double = trace(mission("radio.range_m=6"), seed=1).tagged.sum(axis=1) > 1
    assert referee.longest(double) > 10


def test_the_tagged_are_nearer_than_the_sensing_range_and_times_of_loss_run_down() -> None:
    kept = trace(mission(AS_PRINTED), seed=1)
    weights = graph(kept)
    tags = referee.tagging(weights)
    assert tags.sum(axis=1).max() == 1
    assert referee.distance_vector(weights, tags).max() <= RANGE_M
    left = referee.time_of_loss(weights, tags, tick_s=0.1)
    both = np.isfinite(left[:-1]) & tags[1:]
    assert both.any()
    assert np.allclose(left[:-1][both] - left[1:][both], 0.1)


@pytest.mark.slow
@pytest.mark.parametrize("changes", MISSIONS.values(), ids=MISSIONS)
def test_for_many_seeds(changes: tuple[str, ...]) -> None:
    for seed in range(1, 31):
        kept = trace(mission(*changes), seed=seed)
        assert np.array_equal(referee.events(kept.tagged).sum(axis=0), kept.events)
        assert referee.longest(kept.tagged.sum(axis=1) > 1) <= 1
