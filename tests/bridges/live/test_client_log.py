"""Log messages of a client, and types that only the simulation knows."""

from __future__ import annotations

import subprocess
import sys
import threading
import zipfile
from pathlib import Path
from typing import Any

import pytest

import simkit
from simkit.live import Client, Server
from simkit_verification.testing.bundles import keep, replay, write_bundle

YARD = '<sdf version="1.9"><world name="yard"><model name="ball"><link name="l"/></model></world></sdf>'


def messages(sim: simkit.Simulation) -> list[tuple[str, int, str]]:
    """Those of the client that `/rosout` gives to a later subscriber."""
    found = sim.subscribe("/rosout").messages
    return [(m.name, m.level, m.msg) for m in found if m.name != "simkit"]


def test_a_client_logs_on_a_terminal_and_to_rosout_for_later_subscribers(
    court: simkit.Simulation, run: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    with run(court, node="/lab/talker") as client:
        early = client.subscribe("/rosout")
        client.log.info("gain %.1f", 2.0)
        client.log.debug("not shown")
        client.log.setLevel("DEBUG")
        client.log.debug("shown")
        client.log.warning("low battery")
        client.flush()
        heard = [r for r in early.waiting if r.message.name == "lab.talker"][-1]
        assert (heard.message.msg, heard.message.level, heard.message.function) == ("low battery", 30, _name())
        assert heard.message.stamp.sec * 10**9 + heard.message.stamp.nanosec == heard.time_ns
        late = client.subscribe("/rosout")
        client.flush()
        found = [r.message for r in late.waiting if r.message.name == "lab.talker"]
        assert [(m.level, m.msg) for m in found] == [(20, "gain 2.0"), (10, "shown"), (30, "low battery")]
        assert client.ask("nodes")["/lab/talker"]["publishers"] == {"/rosout": ["rcl_interfaces/msg/Log"]}
    printed = [line.partition("]: ")[2] for line in capsys.readouterr().err.splitlines()]
    assert printed == ["gain 2.0", "shown", "low battery"]
    assert not messages(court), "the messages of a node end with the node"


def _name() -> str:
    return sys._getframe(1).f_code.co_name


def test_each_node_keeps_its_last_thousand_messages(court: simkit.Simulation) -> None:
    log = court.advertise("/rosout", "rcl_interfaces/msg/Log", latched=True)
    for number in range(1100):
        log.publish({"name": "script", "level": 20, "msg": str(number)})
    found = messages(court)
    assert (len(found), found[0][2], found[-1][2]) == (1000, "100", "1099")


def test_a_client_logs_after_the_end_of_the_simulation(
    court: simkit.Simulation, run: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    with run(court) as client:
        client.log.info("first")
    client.log.info("last")
    assert "]: last\n" in capsys.readouterr().err


SERVER = """
import sys
from simkit.live import connect

with connect("court", node="adder") as node:
    node.offer("/add", "far_msgs/srv/Sum", lambda request: {"sum": request.a + request.b})
    node.act("/grow", "far_msgs/action/Grow", lambda goal: {"size": 2 * goal.request.size})
    try:
        node.offer("/none", "far_msgs/srv/None", print)
    except Exception as error:
        print(type(error).__name__, flush=True)
    node.spin()
"""


def test_another_process_serves_types_that_only_the_simulation_knows(
    court: simkit.Simulation, run: Any, tmp_path: Path
) -> None:
    simkit.msgs.add("far_msgs/srv/Sum", "int64 a\nint64 b\n---\nint64 sum")
    simkit.msgs.add("far_msgs/action/Grow", "float64 size\n---\nfloat64 size\n---\n")
    with run(court) as client:
        process = subprocess.Popen([sys.executable, "-c", SERVER], stdout=subprocess.PIPE, text=True, cwd=tmp_path)
        try:
            assert process.stdout is not None
            assert process.stdout.readline() == "MessageError\n"
            assert client.call("/add", {"a": 2, "b": 40}).sum == 42
            goal = client.send_goal("/grow", {"size": 1.5})
            assert goal.wait(20.0)
            assert goal.result.size == 3.0
        finally:
            process.kill()
            process.communicate()


def test_logging_is_an_external_input_that_a_bundle_repeats(sockets: Path) -> None:
    with simkit.load(YARD) as sim, keep(sim), Server(sim) as server:
        thread = threading.Thread(target=log_once, args=(server.path,))
        thread.start()
        while thread.is_alive():
            server.poll(0.01)
        sim.step(5)
        bundle = write_bundle(sim, sockets.parent / "run.zip")
    with zipfile.ZipFile(bundle) as archive:
        assert b"from outside" in archive.read("commands.jsonl")
    found = replay(bundle)
    assert found.is_same
    assert not found.refused


def log_once(path: Path) -> None:
    with Client(path, node="outside") as client:
        client.log.info("from outside")
        client.flush()
