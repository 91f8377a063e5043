"""When a battery sends its agent home."""

from __future__ import annotations

import pytest

from comms.status import Level
from swarm_agent.reserve import SAGS_S, Battery, Reserve, ReserveConfig

CONFIG = ReserveConfig(share=0.2, voltage_v=10.8)
FULL = Battery(0.9, 12.2)


def test_a_battery_at_its_reserve_stays_spent_and_is_told_once() -> None:
    mine = Reserve(CONFIG)
    shares = (None, 0.9, 0.21, 0.2, 0.5, None)
    assert [mine.spent(tick, Battery(share)) for tick, share in enumerate(shares)] == [False] * 3 + [True] * 3
    assert [(event.level, event.text) for event in mine.take_events()] == [(Level.ERROR, "battery at 20%: coming home")]
    assert mine.take_events() == ()


def test_a_voltage_counts_once_it_lasts() -> None:
    mine, sagging = Reserve(CONFIG), Battery(0.9, 10.7)
    assert not mine.spent(0.0, sagging)
    assert not mine.spent(SAGS_S - 0.1, sagging)
    assert not mine.spent(SAGS_S, FULL)  # it was the load
    assert not mine.spent(SAGS_S + 0.1, sagging)
    assert not mine.spent(2 * SAGS_S, sagging)
    assert mine.spent(2 * SAGS_S + 0.1, sagging)
    assert [event.text for event in mine.take_events()] == ["battery at 10.7 V: coming home"]


@pytest.mark.parametrize("config", [CONFIG, ReserveConfig()])
def test_what_the_autopilot_calls_low_is_low(config: ReserveConfig) -> None:
    assert Reserve(config).spent(0.0, FULL._replace(is_low=True))


@pytest.mark.parametrize("battery", [Battery(), Battery(0.0, 0.1), FULL])
def test_without_a_reserve_nothing_but_the_autopilot_counts(battery: Battery) -> None:
    mine = Reserve(ReserveConfig())
    assert not any(mine.spent(now_s, battery) for now_s in (0.0, 60.0))
