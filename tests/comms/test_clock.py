"""A clock that counts how long a process could look, with the wall clock in the test's hand."""

from __future__ import annotations

import pytest

from comms import clock


def test_a_sleep_that_nobody_asked_for_hardly_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    wall_s = [100.0]
    monkeypatch.setattr(clock.time, "monotonic", lambda: wall_s[0])
    awake = clock.Awake(most_s=1.0)
    read = []
    for passed_s in (0.0, 0.2, 0.9, 60.0, 0.3):
        wall_s[0] += passed_s
        read.append(awake.now_s())
    assert read == pytest.approx([0.0, 0.2, 1.1, 2.1, 2.4])
