"""Lifecycle nodes of plugins and scripts: transitions, events, callbacks that fail, snapshots, resets and bundles."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import simkit
from simkit.errors import PluginError, ServiceError, SubscriberError
from simkit.lifecycle import LifecycleNode
from simkit_verification.testing.bundles import keep, replay, write_bundle

YARD = '<sdf version="1.9"><world name="yard"><model name="ball"><link name="l"/></model></world></sdf>'


class Driver(simkit.WorldPlugin):
    """Counts the steps while it is active."""

    def load(self, parent: Any, params: Any) -> None:
        self.lifecycle = LifecycleNode(self)
        self.calls: list[tuple[str, str]] = []
        self.answer: Any = None
        self.steps = 0

    def on_configure(self, previous: str) -> Any:
        self.calls.append(("configure", previous))
        return self.answer

    def on_activate(self, previous: str) -> Any:
        self.calls.append(("activate", previous))
        if isinstance(self.answer, Exception):
            raise self.answer
        return self.answer

    def on_shutdown(self, previous: str) -> Any:
        self.calls.append(("shutdown", previous))
        return self.answer

    def after_step(self) -> None:
        self.steps += self.lifecycle.is_active


@pytest.fixture
def driver() -> Driver:
    return Driver()


@pytest.fixture
def sim(driver: Driver) -> Iterator[simkit.Simulation]:
    with simkit.load(YARD, plugins=[driver]) as sim:
        yield sim


def change(sim: simkit.Simulation, label: str = "", number: int = 0, node: str = "/Driver") -> bool:
    found: bool = sim.call(f"{node}/change_state", {"transition": {"label": label, "id": number}}).success
    return found


def state(sim: simkit.Simulation, node: str = "/Driver") -> tuple[int, str]:
    found = sim.call(f"{node}/get_state").current_state
    return found.id, found.label


def test_a_plugin_is_configured_activated_and_shut_down_as_a_node_of_ros(sim: simkit.Simulation, driver: Any) -> None:
    events = sim.subscribe("/Driver/transition_event")
    assert state(sim) == (1, "unconfigured")
    assert [change(sim, "configure"), change(sim, "configure"), change(sim, number=3)] == [True, False, True]
    sim.step(3)
    assert (state(sim), driver.lifecycle.state, driver.steps) == ((3, "active"), "active", 3)
    assert [change(sim, "deactivate"), change(sim, "cleanup"), change(sim, "shutdown")] == [True] * 3
    assert state(sim) == (4, "finalized")
    assert not sim.call("/Driver/get_available_transitions").available_transitions
    assert driver.calls == [("configure", "unconfigured"), ("activate", "inactive"), ("shutdown", "unconfigured")]
    seen = [(e.transition.id, e.start_state.label, e.goal_state.label) for e in events.messages]
    assert seen[:3] == [
        (1, "unconfigured", "configuring"),
        (10, "configuring", "inactive"),
        (3, "inactive", "activating"),
    ]
    assert [number for number, _, _ in seen] == [1, 10, 3, 30, 4, 40, 2, 20, 5, 50]
    assert events.messages[-1].timestamp == sim.time_ns == 3_000_000


def test_a_failure_goes_back_and_a_shutdown_is_final_even_if_it_fails(sim: simkit.Simulation, driver: Any) -> None:
    driver.answer = False
    assert not change(sim, "configure")
    assert state(sim) == (1, "unconfigured")
    driver.answer = None
    assert change(sim, "configure")
    driver.answer = False
    assert not change(sim, "activate")
    assert state(sim) == (2, "inactive")
    assert not change(sim, "shutdown")
    assert state(sim) == (4, "finalized")


def test_the_graph_has_the_states_and_transitions_of_ros(sim: simkit.Simulation) -> None:
    graph = sim.call("/Driver/get_transition_graph").available_transitions
    found = [(t.transition.id, t.transition.label, t.start_state.id, t.goal_state.id) for t in graph]
    assert len(found) == 25
    assert found[:4] == [
        (1, "configure", 1, 10),
        (10, "transition_success", 10, 2),
        (11, "transition_failure", 10, 1),
        (12, "transition_error", 10, 15),
    ]
    assert found[16:19] == [(5, "shutdown", 1, 12), (6, "shutdown", 2, 12), (7, "shutdown", 3, 12)]
    assert found[-3:] == [
        (60, "transition_success", 15, 1),
        (61, "transition_failure", 15, 4),
        (62, "transition_error", 15, 4),
    ]
    states = sim.call("/Driver/get_available_states").available_states
    assert [s.id for s in states] == [0, 1, 2, 3, 4, 10, 11, 12, 13, 14, 15]
    change(sim, "configure")
    possible = sim.call("/Driver/get_available_transitions").available_transitions
    assert [t.transition.label for t in possible] == ["cleanup", "activate", "shutdown"]


def test_snapshots_and_resets_have_the_state(sim: simkit.Simulation) -> None:
    change(sim, "configure")
    inactive = sim.snapshot()
    change(sim, "activate")
    late = LifecycleNode(sim, "/late")
    assert late.change("configure")
    sim.restore(inactive)
    assert (state(sim), late.state) == ((2, "inactive"), "unconfigured")
    assert change(sim, "activate")
    sim.reset()
    assert state(sim) == (1, "unconfigured")


def test_an_exception_ends_the_run_or_is_handled_by_on_error(sim: simkit.Simulation, driver: Any) -> None:
    class Camera:
        def on_configure(self, _: str) -> None:
            raise OSError("no camera")

    class Forgiving(Camera):
        def on_error(self, previous: str) -> bool:
            return previous == "errorprocessing"

    LifecycleNode(sim, "/forgiving", Forgiving())
    assert not change(sim, "configure", node="/forgiving")
    assert state(sim, "/forgiving") == (1, "unconfigured")
    texts = [m.msg for m in sim.subscribe("/rosout").messages]
    assert "/forgiving: the callback of a transition raised OSError('no camera')" in texts
    LifecycleNode(sim, "/camera", Camera())
    with pytest.raises(SubscriberError, match="no camera"):
        change(sim, "configure", node="/camera")
    assert state(sim, "/camera") == (4, "finalized")
    change(sim, "configure")
    driver.answer = ValueError("too hot")
    with pytest.raises(PluginError, match="too hot"):
        change(sim, "activate")


def test_a_node_exists_once_and_can_be_closed(sim: simkit.Simulation) -> None:
    node = LifecycleNode(sim, "gripper")
    assert repr(node) == "<LifecycleNode '/gripper': unconfigured>"
    with pytest.raises(ServiceError, match="'/gripper/change_state' exists already"):
        LifecycleNode(sim, "/gripper")
    assert node.change("configure"), "the second one has closed nothing of the first"
    node.close()
    assert not [name for name in sim.topics() if "gripper" in name]
    with pytest.raises(ServiceError, match="no service"):
        state(sim, "/gripper")
    assert LifecycleNode(sim, "gripper").state == "unconfigured"
    with pytest.raises(simkit.InputError, match="node"):
        LifecycleNode(sim)


def test_plugins_of_the_same_name_are_nodes_of_their_own() -> None:
    with simkit.load(YARD, plugins=[Driver(), Driver()]) as sim:
        nodes = [name.removesuffix("/get_state") for name in sim.communication.services.names() if "get_state" in name]
        assert len(set(nodes)) == 2
        assert change(sim, "configure", node=nodes[1])
        assert [state(sim, node)[0] for node in nodes] == [1, 2]


def test_a_bundle_repeats_the_transitions_of_a_script(tmp_path: Path) -> None:
    with simkit.load(YARD) as sim, keep(sim):

        class Pusher:
            def on_activate(self, _: str) -> None:
                sim.model("ball").set_velocity((1.0, 0.0, 0.0), (0.0, 0.0, 0.0))

        LifecycleNode(sim, "/pusher", Pusher())
        change(sim, "configure", node="/pusher")
        sim.step(5)
        change(sim, "activate", node="/pusher")
        sim.step(5)
        bundle = write_bundle(sim, tmp_path / "run.zip")
    found = replay(bundle)
    assert found.is_same
    assert not found.refused
