"""`/rosout`: log messages of plugins and diagnostics of simkit as messages of ROS 2."""

from __future__ import annotations

import logging
import threading
from collections.abc import Iterator
from typing import Any

import pytest

import simkit
from simkit.runtime.engine.snapshot import state_hash

WORLD = '<sdf version="1.9"><world name="w"><bogus/></world></sdf>'


class Talker(simkit.WorldPlugin):
    def load(self, parent: Any, params: simkit.Params) -> None:
        self.log.info("hello %d", 3)

    def after_step(self) -> None:
        self.log.info("step %d", self.sim.tick)
        self.log.debug("detail")
        if self.sim.tick == 2:
            self.log.warning("two")


@pytest.fixture
def sim() -> Iterator[simkit.Simulation]:
    with simkit.load(WORLD, plugins=[Talker()]) as sim:
        yield sim


def _told(subscription: Any) -> list[tuple[int, str, str]]:
    return [(message.level, message.name, message.msg) for message in subscription.messages]


def test_a_later_subscriber_receives_the_load_and_the_printed_messages(sim: simkit.Simulation) -> None:
    sim.step(3)
    heard = _told(sim.subscribe("/rosout"))
    assert [(level, name) for level, name, _ in heard] == [(30, "simkit"), (20, "Talker"), (30, "Talker")]
    assert heard[0][2].startswith("SK-SDF-011 ") and [text for _, _, text in heard[1:]] == ["hello 3", "two"]


def test_a_subscriber_receives_messages_from_level_info_with_time_and_place(sim: simkit.Simulation) -> None:
    sim.step(3)
    heard = sim.subscribe("/rosout")
    count = len(heard.messages)
    sim.step(2)
    assert _told(heard)[count:] == [(20, "Talker", "step 4"), (20, "Talker", "step 5")]
    assert (heard.latest.stamp.sec, heard.latest.stamp.nanosec) == (0, 5_000_000)
    assert heard.latest.function == "after_step" and heard.latest.file == __file__ and heard.latest.line > 0


def test_a_lower_level_of_the_python_logger_publishes_and_prints_debug_messages(
    sim: simkit.Simulation, caplog: pytest.LogCaptureFixture
) -> None:
    heard = sim.subscribe("/rosout")
    with caplog.at_level(logging.DEBUG, "simkit.plugins.Talker"):
        sim.step()
    sim.step()
    assert (10, "Talker", "detail") in _told(heard) and _told(heard).count((10, "Talker", "detail")) == 1
    assert [record.getMessage() for record in caplog.records][:2] == ["step 1", "detail"]


def test_a_run_has_the_same_state_with_and_without_a_subscriber() -> None:
    hashes = set()
    for hears in (True, False):
        with simkit.load(WORLD, plugins=[Talker()]) as sim:
            if hears:
                sim.subscribe("/rosout")
            sim.step(5)
            hashes.add(state_hash(sim))
    assert len(hashes) == 1


def test_the_newest_thousand_messages_are_kept(sim: simkit.Simulation) -> None:
    log = sim.engine.structure.all_plugins()[-1].log
    for number in range(1200):
        log.warning("%d", number)
    heard = sim.subscribe("/rosout")
    assert [message.msg for message in heard.messages] == [str(number) for number in range(200, 1200)]


def test_a_subscriber_may_log(sim: simkit.Simulation) -> None:
    log = sim.engine.structure.all_plugins()[-1].log
    heard = sim.subscribe("/rosout", lambda message: log.error("heard"))
    log.error("first")
    assert [message.msg for message in heard.messages][-1] == "first"
    assert [message.msg for message in sim.subscribe("/rosout").messages][-2:] == ["first", "heard"]


def test_a_message_of_another_thread_is_published_by_the_thread_of_the_simulation(sim: simkit.Simulation) -> None:
    log = sim.engine.structure.all_plugins()[-1].log
    threads: list[tuple[str, int]] = []
    sim.subscribe("/rosout", lambda message: threads.append((message.msg, threading.get_ident())))
    worker = threading.Thread(target=log.error, args=("from a thread",))
    worker.start()
    worker.join()
    assert not [text for text, _ in threads if text == "from a thread"]
    sim.step()
    assert ("from a thread", threading.get_ident()) in threads


def test_a_diagnostic_of_the_run_and_an_exception_are_messages(
    sim: simkit.Simulation, monkeypatch: pytest.MonkeyPatch
) -> None:
    heard = sim.subscribe("/rosout")
    sim.engine.reports.warning("SK-TOPIC-004", "many \ud800 messages", hint="send less")
    log = sim.engine.structure.all_plugins()[-1].log
    monkeypatch.setattr(logging.getLogger(log.name), "propagate", False)  # pytest-xdist cannot send the text
    try:
        raise ValueError("bad text")
    except ValueError:
        log.exception("failed")
    first, second = heard.messages[-2:]
    assert (first.level, first.name, first.msg) == (30, "simkit", "SK-TOPIC-004 many ? messages; help: send less")
    assert second.level == 40 and second.msg.startswith("failed\nTraceback") and "ValueError" in second.msg
    assert simkit.msgs.serialize(first)
