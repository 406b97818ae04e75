"""The connection of a program to a simulation, driven by hand: what is sent in which order, and its end."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path
from typing import Final, TypeVar

import pytest

import simkit
from simkit.bridges.simulation_link import SimulationLink
from simkit.live import LiveClosed, Server
from simkit.msgs import type_of
from simkit_nodes.live_host import LiveHost
from simkit_nodes.live_program import LiveProgram
from simkit_nodes.live_topics import LiveTopics
from simkit_nodes.node_options import NodeOptions

T = TypeVar("T")
TEXT: Final = "std_msgs/msg/String"


@pytest.fixture
def server(sockets: Path) -> Iterator[Server]:
    """The socket of the world `empty`, which is polled only by hand."""
    with simkit.load("empty") as sim, Server(sim) as server:
        yield server


def connected(server: Server, connect: Callable[[], T]) -> T:
    """Return the result of a function that waits for answers of the simulation."""
    results: list[T] = []
    thread = threading.Thread(target=lambda: results.append(connect()))
    thread.start()
    while thread.is_alive():
        server.poll(0.001)
    return results[0]


def exchange(server: Server, link: SimulationLink) -> None:
    """Have the simulation answer the requests, and call the functions for the answers."""
    while server.poll():
        pass
    while link.receive(0.0):
        pass
    link.dispatch_answers()


def test_the_messages_of_a_publisher_that_is_closed_before_the_answer_arrive(server: Server) -> None:
    problems: list[str] = []
    received = server.sim.subscribe("/last_words")
    with closing(connected(server, lambda: SimulationLink(server.path, problems.append, is_bridge=False))) as link:
        publisher = LiveTopics(link, problems.append).advertise("talker", "/last_words", TEXT, is_latched=False)
        for word in ("one", "two"):
            publisher.publish(type_of(TEXT)(data=word))
        publisher.close()
        publisher.close()
        publisher.publish(type_of(TEXT)(data="after the end"))
        exchange(server, link)  # `advertise` is answered; the messages and `unadvertise` are sent
        exchange(server, link)
        server.sim.step()
        assert link.closed is None and not problems
    assert [message.data for message in received.messages] == ["one", "two"]
    assert not any(peer.publishers for peer in server.peers.values())


class RecordingHost(LiveHost):
    """World around a program that is not ended by a signal."""

    def kill(self) -> None:
        """Do nothing: the program of this test is the test."""


def test_a_program_whose_own_message_meets_the_end_of_the_simulation_is_told(server: Server, tmp_path: Path) -> None:
    (tmp_path / "program.py").write_text("")
    host = connected(server, lambda: RecordingHost(server.path, "program"))
    ended: list[LiveClosed | None] = []
    with closing(host._link), closing(host._alarm), closing(host._alarm_in):
        host._program = LiveProgram(host, tmp_path / "program.py", NodeOptions())
        host._program.on_end.append(lambda: ended.append(host.closed))
        server.close("the run is over")
        while not host._link.is_closed:
            host._link.publish(1, b"")
        host._exchange_data()  # as its thread does next
    assert [str(reason) for reason in ended] == ["SK-LIVE-005 the run is over"]
