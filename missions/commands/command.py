"""One verb of the command line: what it is called, what it may be told, and what it does."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.util import find_spec

from missions.problems import InputError


@dataclass(frozen=True, slots=True, kw_only=True)
class Command:
    """A verb.

    Attributes:
        summary: one line of `swarm --help`. examples: what follows its options in `swarm VERB --help`.
        add_options: puts its options on a parser. run: does it, and returns the exit code.
        usage: in place of the one that names all options, where they are too many.
    """

    name: str
    summary: str
    examples: str
    add_options: Callable[[argparse.ArgumentParser], None]
    run: Callable[[argparse.Namespace], int]
    usage: str | None = None


def need_extra(verb: str, extra: str, packages: Sequence[str]) -> None:
    """Go on only where the packages of an extra are installed.

    Raises:
        InputError: one is not; how to install it.
    """
    missing = [name for name in packages if find_spec(name) is None]
    if missing:
        need = f"swarm {verb} needs the `{extra}` extra: pip install 'swarm-mission-stack[{extra}]'"
        raise InputError(f"{need} (no module {missing[0]!r})")
