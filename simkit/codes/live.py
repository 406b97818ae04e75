"""Talking to a simulation that runs in another process."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import python

_TWO = """
import simkit
from simkit.live import Server, connect

ball = '<sdf version="1.9"><world name="court"><model name="ball"><link name="l"/></model></world></sdf>'
with simkit.load(ball) as one, simkit.load(ball) as other, Server(one), Server(other):
    connect({name})
"""
_ASKING = """
import threading

import simkit
from simkit.live import Server, connect

ball = '<sdf version="1.9"><world name="court"><model name="ball"><link name="l"/></model></world></sdf>'
with simkit.load(ball) as sim, Server(sim) as server:
    over = threading.Event()

    def run():
        while not over.is_set():
            server.poll(wait=0.01)

    runner = threading.Thread(target=run)
    runner.start()
    try:
        with connect(server.name) as client:
            {asked}
    finally:
        over.set()
        runner.join()
"""

CODES: tuple[Code, ...] = (
    Code(
        "SK-LIVE-001",
        "error",
        "no simulation runs that could be talked to",
        "`simkit run WORLD` in another terminal of the same user starts one",
        without="it depends on what else runs",
    ),
    Code(
        "SK-LIVE-002",
        "error",
        "several simulations run, and nothing says which is meant",
        "`--sim NAME`, `SIMKIT_SIM`, or `connect(name)`",
        python(_TWO.format(name="")),
    ),
    Code(
        "SK-LIVE-003",
        "error",
        "no simulation of that name runs; the closest is named",
        "names come from `simkit run --name`, else from the world",
        python(_TWO.format(name='"cort"')),
    ),
    Code(
        "SK-LIVE-004",
        "error",
        "a simulation does not answer in time",
        "it may be stopped (Ctrl-Z; `fg` lets it go on), or be busy with something long",
        python(_TWO.replace("court", "yard").format(name='"yard", timeout=0.1')),
    ),
    Code(
        "SK-LIVE-005",
        "error",
        "the simulation has ended",
        without="it depends on the moment",
    ),
    Code(
        "SK-LIVE-006",
        "error",
        "what came is not what simkit's two ends say to each other",
        "both ends are to be of one version of simkit",
        without="one end would have to be something else",
    ),
    Code(
        "SK-LIVE-007",
        "error",
        "there are as many clients, or one has as much open, as is allowed",
        "close what is not needed any more",
        python(_ASKING.format(asked='subscriptions = [client.subscribe(f"/topic_{n}") for n in range(1001)]')),
    ),
    Code(
        "SK-LIVE-008",
        "error",
        "a question that the simulation cannot answer; what is allowed is said",
        "",
        python(_ASKING.format(asked='client.control("rest")')),
    ),
    Code(
        "SK-LIVE-009",
        "note",
        "a run has no place for its socket, and goes on without one",
        "the folder `$XDG_RUNTIME_DIR/simkit`, or `simkit-<uid>` among the temporary files, has to be its user's alone",
        without="it depends on the machine",
    ),
)
