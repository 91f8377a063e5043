"""Lines of the timeline on a console: colored, and folded so that their words stay in their column."""

from __future__ import annotations

import textwrap

from rich.console import Console
from rich.text import Text

from comms.status import Level
from missions.colors import ACTIVITY_INKS, LEVEL_INKS, hex_color
from missions.review.timeline import INDENT, Line

# A narrower column than this is no column.
_NARROWEST = 24


def print_line(line: Line, console: Console, *, style: str = "") -> None:
    """Print one line: where somebody looks it is folded, for other programs it stays one."""
    text = str(line)
    if console.is_terminal and console.width >= INDENT + _NARROWEST:
        text = textwrap.fill(text, console.width, subsequent_indent=" " * INDENT)
    console.print(Text(text, style or color_of(line)), soft_wrap=True)


def color_of(line: Line) -> str:
    """The color of what its speaker does, unless it is a warning or worse."""
    if line.level is Level.INFO and line.activity is not None:
        return hex_color(ACTIVITY_INKS[line.activity])
    return hex_color(LEVEL_INKS[line.level])
