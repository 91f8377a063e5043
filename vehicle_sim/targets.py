"""How targets move: one scalar rule each for evasive, random and static targets, shared by missions and studies.

A rule takes one target's position and heading (unit vector) and returns the next ones. Targets never leave the arena.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from comms.arena import Arena, clamped, reflected
from comms.chance import TARGET_ANGLE, TARGET_TURN, draw

Column = Any  # a list of numbers, or a numpy array in a study

RIGHT_BELOW_M = 1e-3  # an agent this near gives no direction to flee to
BALANCED = 1e-6  # flight directions whose sum is shorter than this cancel out
WANDER_TURN_RAD_SQRT_S = 0.2  # how a target's walk diffuses with nothing near
TURNS_PER_S = 0.05  # random targets: chance of a turn
LARGEST_TURN_RAD = 1.5707963267948966  # of up to 90 degrees

State = tuple[float, float, float, float]


def flight_direction(
    x: float, y: float, agents_x: Column, agents_y: Column, range_m: float
) -> tuple[float, float, bool]:
    """Where an evasive target flees (eq. 8): along the sum of unit vectors away from every agent within `range_m`.

    Returns:
        A unit vector and True; or (0, 0) and False if nothing drives it: nobody near, or all pushes cancel out.
    """
    sum_x = sum_y = 0.0
    for i in range(len(agents_x)):
        dx, dy = x - agents_x[i], y - agents_y[i]
        squared = dx * dx + dy * dy
        if squared <= range_m * range_m:
            distance = sqrt(squared)
            if distance > RIGHT_BELOW_M:
                sum_x += dx / distance
                sum_y += dy / distance
    norm = sqrt(sum_x * sum_x + sum_y * sum_y)
    if norm < BALANCED:
        return 0.0, 0.0, False
    return sum_x / norm, sum_y / norm, True


def anyone_within(x: float, y: float, agents_x: Column, agents_y: Column, range_m: float) -> bool:
    """Whether a target at (x, y) notices any agent."""
    for i in range(len(agents_x)):
        dx, dy = x - agents_x[i], y - agents_y[i]
        if dx * dx + dy * dy <= range_m * range_m:
            return True
    return False


def advance(arena: Arena, x: float, y: float, ux: float, uy: float, step_m: float) -> State:
    """Straight on by `step_m`; at the edge it stops there and turns back into the arena as light is reflected."""
    wanted_x, wanted_y = x + ux * step_m, y + uy * step_m
    next_x, next_y = clamped(arena, wanted_x, wanted_y)
    if next_x != wanted_x or next_y != wanted_y:
        ux, uy = reflected(arena, wanted_x, wanted_y, ux, uy)
    return next_x, next_y, ux, uy


def turned(ux: float, uy: float, tangent: float) -> tuple[float, float]:
    """The heading turned by the angle whose tangent is given (below 90 degrees), left if positive."""
    hx, hy = ux - tangent * uy, uy + tangent * ux
    norm = sqrt(hx * hx + hy * hy)
    return hx / norm, hy / norm


def evade(
    arena: Arena,
    x: float,
    y: float,
    ux: float,
    uy: float,
    agents_x: Column,
    agents_y: Column,
    range_m: float,
    speed_m_s: float,
    tick_s: float,
    seed: int,
    tick: int,
    target: int,
) -> State:
    """An evasive target: flees at full speed from all agents it notices; walks on, wandering, when it notices none.

    With an agent right above and nobody else near, it keeps its heading (0/0 in eq. 8, the d_o1 = 0 case).
    """
    fx, fy, driven = flight_direction(x, y, agents_x, agents_y, range_m)
    if driven:
        next_x, next_y = clamped(arena, x + fx * speed_m_s * tick_s, y + fy * speed_m_s * tick_s)
        return next_x, next_y, fx, fy
    if not anyone_within(x, y, agents_x, agents_y, range_m):
        spread = WANDER_TURN_RAD_SQRT_S * sqrt(3.0 * tick_s)
        ux, uy = turned(ux, uy, (2.0 * draw(seed, tick, target, TARGET_TURN) - 1.0) * spread)
    return advance(arena, x, y, ux, uy, speed_m_s * tick_s)


def roam(
    arena: Arena,
    x: float,
    y: float,
    ux: float,
    uy: float,
    speed_m_s: float,
    tick_s: float,
    seed: int,
    tick: int,
    target: int,
) -> State:
    """A random target: straight on, with a chance of 5 % a second to turn by up to 90 degrees either way."""
    if draw(seed, tick, target, TARGET_TURN) < TURNS_PER_S * tick_s:
        # The sine and cosine of the half-angle come from its tangent: turn twice by half the angle.
        share = 2.0 * draw(seed, tick, target, TARGET_ANGLE) - 1.0
        half = _tangent(share * LARGEST_TURN_RAD / 2.0)
        ux, uy = turned(ux, uy, half)
        ux, uy = turned(ux, uy, half)
    return advance(arena, x, y, ux, uy, speed_m_s * tick_s)


def _tangent(angle_rad: float) -> float:
    """tan for angles up to 45 degrees, in arithmetic that is the same compiled and plain (continued fraction)."""
    square = angle_rad * angle_rad
    return angle_rad / (1.0 - square / (3.0 - square / (5.0 - square / (7.0 - square / 9.0))))
