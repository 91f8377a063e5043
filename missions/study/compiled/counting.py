"""What is kept of a compiled mission: coverage, definition 7 and help, counted as `missions.metrics` does."""

from __future__ import annotations

from missions.metrics import (
    ANSWERED,
    CALL_PAUSE_S,
    CALLS,
    CAPTURED,
    FOUND_AGAIN,
    PURSUED,
    TAG_SWITCH,
    TAKEN_OVER,
    TARGET_DISCOVERY,
    TARGET_LOSS,
)
from missions.study.compiled.rules import inlined
from missions.study.compiled.state import Flock, Kept, Said
from swarm_agent.bcmommt.belief import NOBODY, Table


@inlined
def count(kept: Kept, tables: Table, f: Flock, said: Said, k: int, now: float) -> None:
    """Coverage, definition 7 and help episodes of tick k."""
    m, n = f.owned.shape
    for j in range(n):
        kept.present[k] += f.here[j]
        kept.seen[k] += f.seen[j]
    if _tags_changed(tables, f):  # seldom: definition 7 needs no look at the other ticks
        _count_events(kept, tables, f)
    for i in range(m):
        for c in range(said.n_calls[i]):
            j = said.call[i, c]
            kept.help[CALLS] += now - f.called_at[i, j] > CALL_PAUSE_S
            f.called_at[i, j] = now
        old, new = f.helping[i], said.answer[i]
        if new != old:
            if old != NOBODY:
                _count_end(kept, tables, f, said, i, old)
            if new != NOBODY:
                f.pursuing[i] = tables.calling[i, new]
                kept.help[PURSUED if f.pursuing[i] else ANSWERED] += 1
    for i in range(m):
        f.helping[i] = said.answer[i]


@inlined
def _count_end(kept: Kept, tables: Table, f: Flock, said: Said, i: int, j: int) -> None:
    """How it ended that agent i went after target j."""
    if tables.tagged[i, j]:
        kept.help[FOUND_AGAIN if f.pursuing[i] else CAPTURED] += 1
    elif not f.pursuing[i]:
        kept.help[TAKEN_OVER] += _is_answered(said, j)


@inlined
def _tags_changed(tables: Table, f: Flock) -> bool:
    """Whether any tag differs from the one a tick ago."""
    changed = False
    m, n = f.owned.shape
    for i in range(m):
        for j in range(n):
            changed |= f.owned[i, j] != tables.tagged[i, j]
    return changed


@inlined
def _count_events(kept: Kept, tables: Table, f: Flock) -> None:
    """Losses, discoveries and switches between the tags of one tick ago and now, which become those of one tick ago."""
    m, n = f.owned.shape
    for j in range(n):
        had = has = dropped = False
        for i in range(m):
            had |= f.owned[i, j]
            has |= tables.tagged[i, j]
            dropped |= f.owned[i, j] and not tables.tagged[i, j]
            f.owned[i, j] = tables.tagged[i, j]
        kept.events[TARGET_LOSS] += had and not has
        kept.events[TARGET_DISCOVERY] += has and not had
        kept.events[TAG_SWITCH] += had and has and dropped


@inlined
def _is_answered(said: Said, j: int) -> bool:
    for i in range(len(said.answer)):  # noqa: SIM110  # a generator does not compile
        if said.answer[i] == j:
            return True
    return False


@inlined
def keep_all(kept: Kept, tables: Table, f: Flock, k: int) -> None:
    """Everything of tick k."""
    m, n = f.owned.shape
    for i in range(m):
        kept.agents[k, i, 0], kept.agents[k, i, 1] = f.x[i], f.y[i]
        kept.mode[k, i] = f.mode[i]
        for j in range(n):
            kept.tagged[k, i, j] = tables.tagged[i, j]
            kept.sensed[k, i, j] = tables.sensed[i, j]
    for j in range(n):
        kept.targets[k, j, 0], kept.targets[k, j, 1] = f.target_x[j], f.target_y[j]
