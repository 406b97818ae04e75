"""`sim.run_async`: a simulation in an event loop."""

from __future__ import annotations

import asyncio

import simkit
from simkit.runtime.engine.snapshot import state_hash

WORLD = """<sdf version="1.9"><world name="w"><model name="box"><pose>0 0 1 0.1 0.2 0</pose><link name="l">
<inertial><inertia><ixx>0.1</ixx><iyy>0.2</iyy><izz>0.3</izz></inertia></inertial></link></model></world></sdf>"""


def test_tasks_of_an_event_loop_alternate_and_have_the_bits_of_a_plain_run() -> None:
    order: list[str] = []

    async def run(name: str) -> str:
        with simkit.load(WORLD) as sim:
            sim.subscribe("/clock", lambda _: order.append(name))
            await sim.run_async(0.5)
            assert sim.tick == 500
            return state_hash(sim)

    async def both() -> list[str]:
        return await asyncio.gather(run("a"), run("b"))

    found = asyncio.run(both())
    with simkit.load(WORLD) as sim:
        sim.run(0.5)
        assert found == [state_hash(sim)] * 2
    assert order.index("b") < len(order) - 1 - order[::-1].index("a")  # `b` begins before `a` ends
