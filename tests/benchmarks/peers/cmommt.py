"""One tick of B-CMOMMT for a batch of missions, as torch operations; see the package for what it has and lacks.

Shapes: B missions, m agents, n targets. The batch is the last axis, where torch is fastest: a quantity per agent is
(m, B), per target (n, B), per pair (m, n, B), east and north apart. Meters, seconds, meters a second. INF stands for
"not sensed", "not claimed", "not called", "not answered".
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

import torch
from torch import Tensor

INF = float("inf")
TICK_S = 0.1
ARENA_RADIUS_M = 30.0
DEPLOYMENT_RADIUS_M = 15.0
SENSING_RANGE_M = 5.5
COMM_RANGE_M = 20.0
AGENT_SPEED_M_S = 0.4
TARGET_SPEED_M_S = 0.3
HORIZON_S = 20.0
HELP_MARGIN_S = 40.0
TURN_TIME_S = 0.5
AGENT_WALK_RAD = 0.3 * sqrt(3.0 * TICK_S)
TARGET_WALK_RAD = 0.2 * sqrt(3.0 * TICK_S)


class State(NamedTuple):
    """The world at a tick, and what was seen and said in the tick before.

    Attributes:
        ax, ay: agents. hx, hy: their walk's headings. tx, ty: targets. ux, uy: their headings.
        tx_before, ty_before, distance_before: targets and pair distances (INF: not sensed) one tick ago.
        vx_said, vy_said: velocities of the targets as their watchers knew them one tick ago, (n, B).
        linked: (m, m, B), whether a frame of the second reached the first.
        claim, call, answer: (m, n, B), each agent's frame: distance of a tag, seconds until its loss, time to capture.
    """

    ax: Tensor
    ay: Tensor
    hx: Tensor
    hy: Tensor
    tx: Tensor
    ty: Tensor
    ux: Tensor
    uy: Tensor
    tx_before: Tensor
    ty_before: Tensor
    distance_before: Tensor
    vx_said: Tensor
    vy_said: Tensor
    linked: Tensor
    claim: Tensor
    call: Tensor
    answer: Tensor


class Wish(NamedTuple):
    """What follows from a state: the agents' velocities and the targets' next places and headings."""

    vx: Tensor
    vy: Tensor
    tx: Tensor
    ty: Tensor
    ux: Tensor
    uy: Tensor


def start(m: int, n: int, batch: int, device: torch.device | None = None) -> State:
    """Agents and targets scattered over the deployment disc, nothing known and nothing said yet."""

    def scattered(count: int) -> tuple[Tensor, Tensor]:
        radius = DEPLOYMENT_RADIUS_M * torch.rand(count, batch, device=device).sqrt()
        east, north = _directions(count, batch, device)
        return radius * east, radius * north

    tx, ty = scattered(n)
    nobody = torch.full((m, n, batch), INF, device=device)
    still = torch.zeros_like(tx)
    linked = torch.zeros(m, m, batch, dtype=torch.bool, device=device)
    return State(
        *scattered(m),
        *_directions(m, batch, device),
        tx,
        ty,
        *_directions(n, batch, device),
        tx,
        ty,
        nobody,
        still,
        still,
        linked,
        nobody,
        nobody,
        nobody,
    )


def coverage(s: State) -> Tensor:
    """The share of targets that at least one agent sees in this state, (B,)."""
    return (_distances(s.ax, s.ay, s.tx, s.ty) <= SENSING_RANGE_M).any(0).float().mean(0)


def think(s: State) -> tuple[State, Wish]:
    """Everybody senses, hears, decides and speaks; nobody has moved yet. Positions in the result are those of `s`."""
    east, north = s.tx - s.ax[:, None], s.ty - s.ay[:, None]
    squared = east * east + north * north
    sensed = squared <= SENSING_RANGE_M**2
    apart = squared.sqrt()
    distance = apart.masked_fill(~sensed, INF)
    seen_twice = sensed & (s.distance_before < INF)
    known = seen_twice.float()
    vx, vy = known * ((s.tx - s.tx_before) / TICK_S), known * ((s.ty - s.ty_before) / TICK_S)

    mates_east, mates_north = s.ax - s.ax[:, None], s.ay - s.ay[:, None]
    mates_apart = (mates_east * mates_east + mates_north * mates_north).sqrt()
    claim, call, answer = _heard(s)
    called = call < INF

    # Still helping (the call lives and nobody quicker has taken it over), then the tags (section 4.1, 4.2.2).
    helping = (s.answer < INF) & called & (answer >= s.answer)
    free = ~(claim < torch.where(seen_twice, s.distance_before, distance))
    on_the_way = helping.any(1)[:, None]
    may = ~on_the_way | helping | ((claim == INF) & (answer == INF))
    tagged = sensed & free & may
    count = tagged.sum(1)
    follows = count > 0

    # Loss of each tag (eq. 10, with the motion of center and target), and the calls for all but the nearest.
    share = tagged / count.clamp(min=1)[:, None]
    cx, cy = (share * east).sum(1), (share * north).sum(1)
    cvx, cvy = (share * vx).sum(1), (share * vy).sum(1)
    loss = _time_to_leave(east - cx[:, None], north - cy[:, None], vx - cvx[:, None], vy - cvy[:, None])
    said_claim = distance.masked_fill(~tagged, INF)
    wanted = tagged & (said_claim > said_claim.amin(1, keepdim=True))
    said_call = loss.clamp_(max=HORIZON_S).masked_fill_(~wanted, INF)

    # Answers: the closest unanswered call, else the closest that I reach before whoever answers; commitment.
    px, py = s.tx_before + TICK_S * s.vx_said, s.ty_before + TICK_S * s.vy_said
    to_x, to_y = px - s.ax[:, None], py - s.ay[:, None]
    capture = _intercept_time(to_x, to_y, s.vx_said, s.vy_said)
    eligible = called & (capture < answer)
    rank = (capture + 1.0e6 * (answer < INF)).masked_fill_(~eligible, INF)
    best = rank.amin(1, keepdim=True)
    chosen = torch.where(helping.any(1)[:, None], helping, (rank == best) & eligible) & ~follows[:, None]
    said_answer = capture.masked_fill(~chosen, INF)
    helps = chosen.any(1)

    # Where to: the center of gravity of the tags; the called target once it is urgent; else on with the walk.
    goes = (chosen & (capture > call - HELP_MARGIN_S)).any(1)
    hx, hy = _walk(s, mates_east, mates_north, mates_apart)
    fx, fy = _capped(cx + cvx, cy + cvy)
    gx, gy = _capped((chosen * (to_x + s.vx_said)).sum(1), (chosen * (to_y + s.vy_said)).sum(1))
    wx = torch.where(follows, fx, torch.where(goes, gx, AGENT_SPEED_M_S * hx))
    wy = torch.where(follows, fy, torch.where(goes, gy, AGENT_SPEED_M_S * hy))
    roams = ~follows & ~(helps & goes)
    owns = tagged.float()
    owned = owns / owns.sum(0).clamp(min=1.0)

    after = s._replace(
        hx=torch.where(roams, hx, s.hx),
        hy=torch.where(roams, hy, s.hy),
        tx_before=s.tx,
        ty_before=s.ty,
        distance_before=distance,
        vx_said=(owned * vx).sum(0),
        vy_said=(owned * vy).sum(0),
        linked=mates_apart <= COMM_RANGE_M,
        claim=said_claim,
        call=said_call,
        answer=said_answer,
    )
    return after, Wish(wx, wy, *_evade(s, east, north, apart, sensed))


def step(s: State) -> State:
    """One tick without a simulator around it: think, then move."""
    s, wish = think(s)
    return s._replace(
        ax=s.ax + TICK_S * wish.vx, ay=s.ay + TICK_S * wish.vy, tx=wish.tx, ty=wish.ty, ux=wish.ux, uy=wish.uy
    )


def _heard(s: State) -> tuple[Tensor, Tensor, Tensor]:
    """The least claim, call and answer in the frames that reached each agent, but for its own; three of (m, n, B)."""
    m, n, _ = s.claim.shape
    said = torch.cat((s.claim, s.call, s.answer), 1)
    itself = torch.eye(m, dtype=torch.bool, device=said.device)[:, :, None]
    deaf = torch.zeros_like(s.linked, dtype=said.dtype).masked_fill_(~s.linked | itself, INF)
    # A running minimum over the speakers in one buffer: three times as fast as torch.where and amin over (m, m, 3n, B).
    heard = said[0] + deaf[:, 0, None]
    one = torch.empty_like(heard)
    for mate in range(1, m):
        torch.add(said[mate], deaf[:, mate, None], out=one)
        torch.minimum(heard, one, out=heard)
    return heard[:, :n], heard[:, n : 2 * n], heard[:, 2 * n :]


def _time_to_leave(x: Tensor, y: Tensor, vx: Tensor, vy: Tensor) -> Tensor:
    """When points at (x, y) with velocity (vx, vy) leave the sensing range about the origin: 0 if out."""
    outside = x * x + y * y - SENSING_RANGE_M**2
    speed2 = (vx * vx + vy * vy).clamp(min=1e-12)
    along = x * vx + y * vy
    after = ((along * along - speed2 * outside).clamp(min=0.0).sqrt() - along) / speed2
    return after.masked_fill_(outside >= 0.0, 0.0)


def _intercept_time(dx: Tensor, dy: Tensor, vx: Tensor, vy: Tensor) -> Tensor:
    """Eq. 11 with targets continued linearly: the least t with |d + v t| <= r_s + s_v (t - turn time)."""
    dx, dy = dx + vx * TURN_TIME_S, dy + vy * TURN_TIME_S
    c = dx * dx + dy * dy - SENSING_RANGE_M**2
    a = vx * vx + vy * vy - AGENT_SPEED_M_S**2  # below 0: agents are faster
    b = dx * vx + dy * vy - SENSING_RANGE_M * AGENT_SPEED_M_S
    after = (-b - (b * b - a * c).clamp(min=0.0).sqrt()) / a
    return after.masked_fill_(c <= 0.0, 0.0).add_(TURN_TIME_S)


def _walk(s: State, mates_east: Tensor, mates_north: Tensor, mates_apart: Tensor) -> tuple[Tensor, Tensor]:
    """The next headings of the persistent walk, repelled by mates within two sensing ranges and by the edge."""
    reach = 2.0 * SENSING_RANGE_M
    turn = (2.0 * torch.rand_like(s.hx) - 1.0) * AGENT_WALK_RAD
    near = (mates_apart < reach) & (mates_apart > 1e-6)
    weight = (TICK_S * (1.0 / mates_apart - 1.0 / reach)).masked_fill_(~near, 0.0)
    hx = s.hx - turn * s.hy - (weight * mates_east).sum(1)
    hy = s.hy + turn * s.hx - (weight * mates_north).sum(1)
    out = (s.ax * s.ax + s.ay * s.ay).sqrt().clamp(min=1e-6)
    edge = 2.0 * TICK_S * (1.0 - (ARENA_RADIUS_M - out) / SENSING_RANGE_M).clamp(min=0.0) / out
    hx, hy = hx - edge * s.ax, hy - edge * s.ay
    norm = (hx * hx + hy * hy).sqrt().clamp(min=1e-9)
    return hx / norm, hy / norm


def _evade(
    s: State, east: Tensor, north: Tensor, apart: Tensor, noticed: Tensor
) -> tuple[Tensor, Tensor, Tensor, Tensor]:
    """Eq. 8: targets flee along the sum of unit vectors away from the agents they notice; else they walk on."""
    weight = (1.0 / apart).masked_fill_(~(noticed & (apart > 1e-3)), 0.0)
    fx, fy = (weight * east).sum(0), (weight * north).sum(0)
    norm = (fx * fx + fy * fy).sqrt()
    driven = norm >= 1e-6
    turn = (2.0 * torch.rand_like(s.ux) - 1.0) * TARGET_WALK_RAD * ~noticed.any(0)
    wx, wy = s.ux - turn * s.uy, s.uy + turn * s.ux
    walk = (wx * wx + wy * wy).sqrt()
    ux, uy = torch.where(driven, fx / norm, wx / walk), torch.where(driven, fy / norm, wy / walk)
    x, y = s.tx + TARGET_SPEED_M_S * TICK_S * ux, s.ty + TARGET_SPEED_M_S * TICK_S * uy
    out = (x * x + y * y).sqrt()
    shrink = (ARENA_RADIUS_M / out).clamp(max=1.0)
    # At the edge those that walk turn back into the arena as light is reflected; those that flee slide along it.
    across = (ux * x + uy * y) / (out * out)
    mirror = torch.where((out > ARENA_RADIUS_M) & ~driven, 2.0 * across.clamp(min=0.0), 0.0)
    return x * shrink, y * shrink, ux - mirror * x, uy - mirror * y


def _capped(vx: Tensor, vy: Tensor) -> tuple[Tensor, Tensor]:
    """(vx, vy) shortened to the agents' speed if it is longer (the min of eq. 7)."""
    share = (AGENT_SPEED_M_S / (vx * vx + vy * vy).sqrt().clamp(min=1e-9)).clamp(max=1.0)
    return vx * share, vy * share


def _distances(ax: Tensor, ay: Tensor, tx: Tensor, ty: Tensor) -> Tensor:
    east, north = tx - ax[:, None], ty - ay[:, None]
    return (east * east + north * north).sqrt()


def _directions(count: int, batch: int, device: torch.device | None) -> tuple[Tensor, Tensor]:
    angle = 2.0 * torch.pi * torch.rand(count, batch, device=device)
    return angle.cos(), angle.sin()
