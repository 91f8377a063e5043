"""Snapshots are few however long a mission is, and what happened between two of them is not forgotten."""

from __future__ import annotations

import numpy as np
import pytest

from missions.review.figures import snapshots
from missions.review.figures.snapshots import Snapshots
from tests.missions.toy_observations import toy_observations, toy_scene


@pytest.mark.parametrize("ticks", [1, 2, 7, 8, 9, 16, 17, 130])
def test_snapshots_are_few_and_tell_of_all_ticks(ticks: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(snapshots, "POINTS", 4)
    made = list(toy_observations(toy_scene(), ticks=ticks))
    watch = Snapshots()
    for seen in made:
        watch.observe(seen)
    times_s = [one.time_s for one in watch.taken]
    assert min(ticks, 4) <= len(times_s) <= 8
    assert (times_s[0], times_s[-1]) == (made[0].time_s, made[-1].time_s)
    assert times_s == sorted({*times_s})
    for one, until_s in zip(watch.taken, [*times_s[1:], np.inf], strict=True):
        meanwhile = [seen for seen in made if one.time_s <= seen.time_s < until_s]
        unseen = [any(not seen.targets[target].seen for seen in meanwhile) for target in range(len(made[0].targets))]
        assert one.unseen.tolist() == unseen
        assert one.agents_m.tolist() == [[*truth.position_m[:2]] for truth in meanwhile[0].truths]
