"""B-CMOMMT as a VMAS scenario: VMAS moves the agents, `cmommt` decides for all of them at once.

Written to VMAS's advantage. The agents are scripted, so that VMAS asks for no observation, reward or action of any;
nothing collides; targets are landmarks that the scenario places, as in VMAS's `discovery`. What VMAS does every step
is what it cannot be asked to leave out.
"""

from __future__ import annotations

from typing import Any

import torch
from torch import Tensor
from vmas.simulator.core import Agent, Landmark, Sphere, World
from vmas.simulator.dynamics.static import Static
from vmas.simulator.scenario import BaseScenario
from vmas.simulator.utils import Color

from tests.benchmarks.peers import cmommt


def _no_action(agent: Agent, world: World) -> None:
    """Scripted agents must have an action; theirs is empty, the velocity is set in `pre_step`."""
    agent.action.u = torch.zeros(world.batch_dim, 0, device=world.device)


class Scenario(BaseScenario):
    """The paper's world in VMAS. Keywords: n_agents, n_targets (10 and 10)."""

    def make_world(self, batch_dim: int, device: torch.device, **kwargs: Any) -> World:
        n_agents, n_targets = kwargs.pop("n_agents", 10), kwargs.pop("n_targets", 10)
        world = World(batch_dim, device, dt=cmommt.TICK_S, drag=0.0)
        for i in range(n_agents):
            world.add_agent(
                Agent(
                    name=f"agent_{i}",
                    shape=Sphere(radius=0.2),
                    collide=False,
                    rotatable=False,
                    dynamics=Static(),
                    action_script=_no_action,
                )
            )
        for j in range(n_targets):
            world.add_landmark(
                Landmark(
                    name=f"target_{j}",
                    shape=Sphere(radius=0.2),
                    collide=False,
                    movable=False,
                    rotatable=False,
                    color=Color.RED,
                )
            )
        return world

    def reset_world_at(self, env_index: int | None = None) -> None:
        world = self.world
        fresh = cmommt.start(len(world.agents), len(world.landmarks), world.batch_dim, world.device)
        if env_index is not None:
            one = torch.arange(world.batch_dim, device=world.device) == env_index
            fresh = cmommt.State(*(torch.where(one, new, old) for new, old in zip(fresh, self.state, strict=True)))
        self.state = fresh
        _place(world.agents, fresh.ax, fresh.ay)
        _place(world.landmarks, fresh.tx, fresh.ty)

    def pre_step(self) -> None:
        """Everybody decides from the places that VMAS holds."""
        places = torch.stack([agent.state.pos for agent in self.world.agents])
        self.state, self.wish = cmommt.think(self.state._replace(ax=places[..., 0], ay=places[..., 1]))
        velocities = torch.stack((self.wish.vx, self.wish.vy), -1)
        for agent, velocity in zip(self.world.agents, velocities, strict=True):
            agent.state.vel = velocity

    def post_step(self) -> None:
        """VMAS has moved the agents; the targets moved in the same tick, from the same state."""
        _, _, *targets = self.wish
        self.state = self.state._replace(**dict(zip(("tx", "ty", "ux", "uy"), targets, strict=True)))
        _place(self.world.landmarks, self.state.tx, self.state.ty)

    def observation(self, agent: Agent) -> Tensor:
        return torch.cat((agent.state.pos, agent.state.vel), -1)

    def reward(self, agent: Agent) -> Tensor:
        """The share of targets in sight: the same for every agent."""
        return self.coverage()

    def coverage(self) -> Tensor:
        """The share of targets in sight, (B,)."""
        places = torch.stack([agent.state.pos for agent in self.world.agents])
        return cmommt.coverage(self.state._replace(ax=places[..., 0], ay=places[..., 1]))


def _place(entities: list[Any], x: Tensor, y: Tensor) -> None:
    for entity, place in zip(entities, torch.stack((x, y), -1), strict=True):
        entity.state.pos = place
