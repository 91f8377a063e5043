"""The console blocks of a page: commands, and what the page shows of their output."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

ELLIPSIS = "..."
_BLOCK = re.compile(r"^```console\n(.*?)^```", re.MULTILINE | re.DOTALL)
_EXIT = re.compile(r"\s*# exits with (\d+)$")


@dataclass(frozen=True)
class Command:
    """One command, the exit code it is to have, and the lines it is to print; a line `...` stands for any lines."""

    text: str
    code: int
    shown: tuple[str, ...]


def commands(page: str) -> Iterator[Command]:
    """Every command of a page, in order."""
    for block in _BLOCK.findall(page):
        for part in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
            first, *shown = part.splitlines()
            code = _EXIT.search(first)
            yield Command(_EXIT.sub("", first), int(code[1]) if code else 0, tuple(shown))


def matches(shown: tuple[str, ...], printed: str) -> bool:
    """Whether a page shows what was printed, blanks at the ends of lines aside."""
    pattern = "".join(
        r"(?:.*\n)*?" if line == ELLIPSIS else re.escape(line.rstrip()).replace(r"\.\.\.", ".*") + r" *\n"
        for line in shown
    )
    return re.fullmatch(pattern, printed) is not None
