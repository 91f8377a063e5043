"""The rules of a mission, compiled: the same functions that fly in the air, made callable from numba.

Importing this module registers them. numba's own cache misses edits in other files, so its folder is named by a hash
of every source that takes part.
"""

from __future__ import annotations

import hashlib
import inspect
import os
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any, TypeVar

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


def _source_hash(modules: tuple[ModuleType, ...]) -> str:
    here = Path(__file__).parent
    sources = [inspect.getsource(module) for module in modules]
    # The loop itself, and whose constants are compiled into it.
    sources += [
        path.read_text(encoding="utf-8") for path in (Path(__file__), here / "loop.py", here.parent / "metrics.py")
    ]
    return hashlib.sha256("\0".join(sources).encode()).hexdigest()[:16]


def _use_cache_of(modules: tuple[ModuleType, ...]) -> None:
    base = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache"))
    os.environ.setdefault("NUMBA_CACHE_DIR", str(base / "swarm-mission-stack" / _source_hash(modules)))


_use_cache_of(RULES)  # numba reads the folder's name once, when it is imported

import numba  # noqa: E402
from numba.extending import register_jitable  # noqa: E402

# A rule gets a table of arrays by value. Called as a function it spends its time copying and counting references;
# inlined, and without counting (no rule allocates), ten agents decide many times faster.
OPTIONS: dict[str, Any] = {"forceinline": True, "_nrt": False, "error_model": "numpy"}


Rule = TypeVar("Rule", bound=Callable[..., Any])


def inlined(rule: Rule) -> Rule:
    """A part of a compiled loop: inlined where it is called, like the rules of a mission."""
    compiled: Rule = numba.njit(**OPTIONS)(rule)
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
            if rule.__module__ == module.__name__:
                register_jitable(**OPTIONS)(rule)


_register(RULES)
