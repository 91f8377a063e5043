"""The battery: charge is drawn, and with a capacity of its own its voltage falls."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vehicle_sim.battery import DISCHARGE, RESISTANCE_OHM, Battery, Charge, charge_at, voltage_at


def test_by_default_the_voltage_stays() -> None:
    charge = Charge(Battery(capacity_mah=1.0))
    charge.drain(effort=1.0, dt_s=3600.0)
    assert (charge.voltage_v, charge.empty, charge.consumed_mah) == (12.6, False, pytest.approx(28_000.0))


def test_with_a_capacity_it_falls_sags_and_runs_out() -> None:
    charge = Charge(Battery())
    charge.supply(voltage_v=12.6, capacity_mah=1000.0)
    volts = []
    while not charge.empty:
        charge.drain(effort=1.0, dt_s=1.0)
        volts.append(charge.voltage_v)
    assert len(volts) == pytest.approx(3600.0 * 1000.0 / 28_000.0, abs=1.0)  # one ampere hour at 28 A
    assert all(b < a for a, b in pairwise(volts))
    assert charge.resting_v - charge.voltage_v == pytest.approx(28.0 * RESISTANCE_OHM)
    charge.drain(effort=0.0, dt_s=1.0)
    assert charge.voltage_v == charge.resting_v == pytest.approx(12.6 * 0.779)


def test_the_voltage_says_how_full_it_is_put_in() -> None:
    charge = Charge(Battery())
    charge.supply(voltage_v=12.6 * 0.914, capacity_mah=2000.0)
    charge.drain(effort=1.0, dt_s=3600.0 * 999.0 / 28_000.0)
    assert not charge.empty
    charge.drain(effort=1.0, dt_s=3600.0 * 2.0 / 28_000.0)
    assert charge.empty


@given(share=st.floats(0.0, 1.0))
def test_charge_and_voltage_are_each_others_inverse(share: float) -> None:
    assert charge_at(voltage_at(share)) == pytest.approx(share, abs=1e-9)


def test_the_discharge_curve_rises_and_ends_at_full() -> None:
    assert all(a[0] < b[0] and a[1] < b[1] for a, b in pairwise(DISCHARGE))
    assert (voltage_at(-1.0), voltage_at(2.0), voltage_at(1.0)) == (DISCHARGE[0][1], 1.0, 1.0)
