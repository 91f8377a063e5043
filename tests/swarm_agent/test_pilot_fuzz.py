"""Bytes that are no messages do a pilot no harm. The storm of hostile frames is `tests/fuzz`."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from swarm_agent.autopilot import Phase, Pilot, Prepare
from tests.swarm_agent.pilot_flight import config
from tests.swarm_agent.scripted_copter import ScriptedCopter


@given(chunks=st.lists(st.binary(max_size=200), max_size=20))
def test_any_bytes(chunks: list[bytes]) -> None:
    pilot = Pilot(config())
    for k, chunk in enumerate(chunks):
        pilot.tick(k * 0.1, chunk, Prepare())
    assert pilot.state.phase is Phase.CONNECT


def test_reads_that_end_mid_frame_do_no_harm() -> None:
    copter, pilot, up, held = ScriptedCopter(), Pilot(config()), b"", b""
    for k in range(300):
        wire = held + copter.tick(k * 0.1, up)
        cut = len(wire) - k % 11  # the rest arrives with the next read
        held = wire[cut:]
        up = pilot.tick(k * 0.1, wire[:cut], Prepare())
    assert pilot.state.ready
    assert pilot.endpoint.bad == 0
