"""How the viewer shows logs: when, how serious, what."""

from __future__ import annotations

import rerun.blueprint as rrb

from missions.recording.tape import TIME_LINE


def event_log(path: str, *, name: str) -> rrb.View:
    """The lines of the log at `path` and below it."""
    kind = rrb.encodings.TextLogColumnKind
    columns = [rrb.encodings.TextLogColumn(shown) for shown in (kind.LogLevel, kind.Body)]
    return rrb.TextLogView(
        origin=path,
        name=name,
        columns=rrb.TextLogColumns(timeline_columns=[TIME_LINE], text_log_columns=columns),
    )
