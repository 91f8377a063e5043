"""The constants of one agent among agents that sense differently far."""

from __future__ import annotations

from swarm_agent.bcmommt.params import Params, with_range


def test_another_range_changes_nothing_else() -> None:
    fields = Params._fields
    distinct = Params(**{field: f"value of {field}" for field in fields})  # type: ignore[arg-type]
    assert with_range(distinct, 7.0) == distinct._replace(sensing_range_m=7.0)
