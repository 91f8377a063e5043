"""Which mission a command line names, and what changes it: MISSION, --seed, --duration, --set."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

from missions.load import bundled_names, load_mission
from missions.mission import Mission
from missions.overrides import Override


def add_mission(parser: argparse.ArgumentParser) -> None:
    """One mission, and what changes it."""
    parser.add_argument("mission", metavar="MISSION", help=mission_help())
    parser.add_argument("--seed", metavar="N", help="another seed: the same as --set seed=N")
    parser.add_argument("--duration", metavar="S", help="another duration: the same as --set duration_s=S")
    add_set(parser)


def add_set(parser: argparse.ArgumentParser) -> None:
    """Other values for a mission's keys."""
    parser.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="KEY=VALUE",
        help="another value, written as YAML, for one key of the mission; may be repeated",
    )


def mission_help() -> str:
    """What may stand for a mission."""
    return f"path of a mission file, or a bundled mission: {', '.join(bundled_names())}"


def mission_of(options: argparse.Namespace) -> Mission:
    """The mission that the options of `add_mission` name.

    Raises:
        InputError: mistakes in it.
    """
    shortcuts = (("--seed", "seed", options.seed), ("--duration", "duration_s", options.duration))
    own = [Override(f"{key}={text}", option) for option, key, text in shortcuts if text is not None]
    return load_mission(options.mission, overrides=[*changes(options.set), *own])


def changes(texts: Sequence[str]) -> list[Override]:
    """What `--set` says, each time it was given."""
    return [Override(text) for text in texts]
