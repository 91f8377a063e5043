"""The rules of a mission, compiled: the same functions that fly in the air, made callable from numba.

Importing this module registers them. numba's own cache misses edits in other files, so its folder has the name of all
sources that take part.
"""

from __future__ import annotations

import inspect
import os
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any, TypeVar

import numba
from numba.extending import overload, register_jitable

import comms.arena
import comms.chance
import comms.link
import comms.messages
import swarm_agent.bcmommt.behaviors
import swarm_agent.bcmommt.belief
import swarm_agent.bcmommt.help
import swarm_agent.bcmommt.loss
import swarm_agent.bcmommt.net
import swarm_agent.bcmommt.params
import swarm_agent.bcmommt.prediction
import swarm_agent.bcmommt.profiles
import swarm_agent.bcmommt.reach
import swarm_agent.bcmommt.step
import swarm_agent.bcmommt.tags
import swarm_agent.policies.a_cmommt
import swarm_agent.policies.basic
import swarm_agent.policies.choice
import swarm_agent.policies.regions
import vehicle_sim.sensing
import vehicle_sim.targets
from missions.study.sources import sources_digest
from swarm_agent.bcmommt.belief import enter

RULES: tuple[ModuleType, ...] = (
    comms.arena,
    comms.chance,
    comms.link,
    comms.messages,
    vehicle_sim.sensing,
    vehicle_sim.targets,
    swarm_agent.bcmommt.net,
    swarm_agent.bcmommt.params,
    swarm_agent.bcmommt.belief,
    swarm_agent.bcmommt.tags,
    swarm_agent.bcmommt.loss,
    swarm_agent.bcmommt.reach,
    swarm_agent.bcmommt.help,
    swarm_agent.bcmommt.behaviors,
    swarm_agent.bcmommt.step,
    swarm_agent.bcmommt.profiles,
    swarm_agent.bcmommt.prediction,
    swarm_agent.policies.a_cmommt,
    swarm_agent.policies.basic,
    swarm_agent.policies.regions,
    swarm_agent.policies.choice,
)


def _name_cache() -> None:
    """numba may be imported already, by others, so that its environment variable would come too late."""
    base = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache"))
    if not os.environ.get("NUMBA_CACHE_DIR"):
        numba.config.CACHE_DIR = str(base / "swarm-mission-stack" / sources_digest())  # type: ignore[attr-defined]


_name_cache()

# A rule gets a table of arrays by value. Called as a function it spends its time copying and counting references;
# inlined, and without counting (no rule allocates), ten agents decide many times faster.
OPTIONS: dict[str, Any] = {"forceinline": True, "_nrt": False, "error_model": "numpy"}


Rule = TypeVar("Rule", bound=Callable[..., Any])


def inlined(rule: Rule) -> Rule:
    """A part of a compiled loop: inlined where it is called, like the rules of a mission."""
    compiled: Rule = numba.njit(**OPTIONS)(rule)
    return compiled


def called(part: Rule) -> Rule:
    """A part of a compiled loop that is seldom used: called, so that it does not burden what it stands in."""
    compiled: Rule = numba.njit(error_model="numpy", _nrt=False)(part)  # type: ignore[call-overload]
    return compiled


def compiled(loop: Rule) -> Rule:
    """A whole loop, called from Python: compiled once and cached, and free of the interpreter's lock while it runs.

    It must not allocate, and its arrays must outlive the call: references are not counted.
    """
    callable_loop: Rule = numba.njit(error_model="numpy", _nrt=False, nogil=True, cache=True)(loop)  # type: ignore[call-overload]
    return callable_loop


def _register(modules: tuple[ModuleType, ...]) -> None:
    for module in modules:
        for _, rule in inspect.getmembers(module, inspect.isfunction):
            if rule.__module__ == module.__name__ and rule is not enter:
                register_jitable(**OPTIONS)(rule)


@overload(enter, jit_options=OPTIONS)  # type: ignore[arg-type]
def _nothing_to_enter(rows: Any, row: Any) -> Callable[..., None]:
    """A study looks at all rows anyway: columns side by side are faster than a list of those that matter."""

    def nothing(rows: Any, row: Any) -> None:
        return None

    return nothing


_register(RULES)
