"""Systems for gz-sim: the order of their hooks, their state, and their order among simkit's plugins."""

from __future__ import annotations

import threading
from typing import Any

import numpy as np
import pytest

import simkit
from simkit_gz_python.math import Vector3d
from simkit_gz_python.plugins.gz_system_plugin import GzSystem
from simkit_gz_python.sim import Link, Model, World, world_entity

WORLD = """<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity><model name="body"><link name="link"/></model>
  </world></sdf>"""


class CallLog:
    """Log of hook calls."""

    def __init__(self, name: str, pages: list[str]) -> None:
        self.name, self.pages = name, pages

    def __deepcopy__(self, memo: dict[int, Any]) -> CallLog:
        return self

    def write(self, hook: str, info: Any) -> None:
        self.pages.append(f"{self.name} {hook} {info.iterations}")


class LoggingSystem:
    def __init__(self, name: str, pages: list[str]) -> None:
        self.diary = CallLog(name, pages)

    def pre_update(self, info: Any, ecm: Any) -> None:
        self.diary.write("pre", info)

    def update(self, info: Any, ecm: Any) -> None:
        self.diary.write("update", info)

    def post_update(self, info: Any, ecm: Any) -> None:
        self.diary.write("post", info)


class LoggingPlugin(simkit.WorldPlugin):
    def __init__(self, pages: list[str]) -> None:
        self.diary = CallLog("own", pages)

    def load(self, parent: Any, params: Any) -> None: ...

    def before_step(self) -> None:
        self.diary.pages.append("own before")

    def after_step(self) -> None:
        self.diary.pages.append("own after")


def test_all_pre_updates_then_all_updates_then_the_physics_then_all_post_updates_run() -> None:
    pages: list[str] = []
    plugins: list[Any] = [
        GzSystem(LoggingSystem("a", pages)),
        LoggingPlugin(pages),
        GzSystem(LoggingSystem("b", pages)),
    ]
    with simkit.load(WORLD, plugins=plugins) as sim:
        sim.step()
    assert pages == [
        *("a pre 1", "own before", "b pre 1", "a update 1", "b update 1"),
        *("a post 1", "own after", "b post 1"),
    ]


class Pusher:
    """System that pushes its body along x with a growing force."""

    def __init__(self) -> None:
        self.steps, self.iterations = 0, [0]

    def configure(self, entity: int, sdf: Any, ecm: Any, events: Any) -> None:
        self.link = Link(Model(World(entity).model_by_name(ecm, "body")).link_by_name(ecm, "link"))
        self.link.enable_velocity_checks(ecm)

    def pre_update(self, info: Any, ecm: Any) -> None:
        self.steps += 1
        self.iterations.append(info.iterations)
        velocity = self.link.world_linear_velocity(ecm)
        self.link.add_world_force(ecm, Vector3d(self.steps - 100 * velocity.x(), 0, 0))


def state(sim: Any) -> list[float]:
    return [*sim.mj_data.qpos.tolist(), *sim.mj_data.qvel.tolist()]


def test_a_restored_run_repeats_bit_for_bit() -> None:
    pusher = Pusher()
    with simkit.load(WORLD, plugins=[GzSystem(pusher)]) as sim:
        sim.step(20)
        saved, iterations = sim.snapshot(), list(pusher.iterations)
        sim.step(30)
        first = state(sim)
        sim.restore(saved)
        assert pusher.iterations == iterations and pusher.steps == 20
        sim.step(30)
        assert state(sim) == first


def test_a_reset_restores_the_state_after_configure_and_then_calls_reset() -> None:
    class WithReset(Pusher):
        def reset(self, info: Any, ecm: Any) -> None:
            self.resets = (getattr(self, "resets", 0) + 1, self.steps, info.iterations)

    pusher = WithReset()
    with simkit.load(WORLD, plugins=[GzSystem(pusher)]) as sim:
        sim.step(20)
        first = state(sim)
        sim.reset()
        assert pusher.steps == 0 and pusher.resets == (1, 0, 0)
        sim.step(20)
        assert state(sim) == first


def test_pending_commands_are_part_of_a_snapshot() -> None:
    class Late:
        """System that sets a velocity after the physics, so that the command waits for the next step."""

        def post_update(self, info: Any, ecm: Any) -> None:
            if info.iterations == 5:
                body = Model(World(world_entity(ecm)).model_by_name(ecm, "body"))
                Link(body.canonical_link(ecm)).set_linear_velocity(ecm, Vector3d(2, 0, 0))

    with simkit.load(WORLD, plugins=[GzSystem(Late())]) as sim:
        sim.step(5)
        saved = sim.snapshot()
        sim.step()
        assert sim.link("body::link").linear_velocity[0] == pytest.approx(2)
        sim.restore(saved)
        sim.step()
        assert sim.link("body::link").linear_velocity[0] == pytest.approx(2)


def test_an_attribute_that_cannot_be_copied_is_reported_once_and_the_others_are_saved() -> None:
    class Drawing(Pusher):
        def __init__(self) -> None:
            super().__init__()
            self.numbers = iter(x for x in range(10))
            self.lock = threading.Lock()  # has no state to restore, so no warning

    pusher = Drawing()
    with simkit.load(WORLD, plugins=[GzSystem(pusher)]) as sim:
        sim.step(3)
        sim.reset()
        assert pusher.steps == 0 and pusher.numbers is not None and pusher.lock is not None
        (found,) = [d for d in sim.diagnostics if d.code == "SK-PLUGIN-006"]
        assert "'numbers'" in found.message


def test_entities_keep_their_numbers_while_models_are_spawned_and_removed() -> None:
    numbers: list[dict[str, int]] = []

    class Counter:
        def post_update(self, info: Any, ecm: Any) -> None:
            numbers.append({Model(e).name(ecm) or "": e for e in World(1).models(ecm)})

    ball = "<sdf version='1.9'><model name='ball'><link name='l'/></model></sdf>"
    with simkit.load(WORLD, plugins=[GzSystem(Counter())]) as sim:
        sim.step()
        start = sim.snapshot()
        sim.spawn(ball, name="first")
        sim.spawn(ball, name="second")
        sim.step()
        sim.remove("first")
        sim.spawn(ball, name="first")
        sim.step()
        sim.restore(start)
        sim.spawn(ball, name="third")
        sim.step()
    before, both, again, third = numbers
    assert before["body"] == both["body"] == again["body"] == 4
    assert both["second"] == again["second"] and both["first"] != again["first"]
    assert third["third"] == both["first"]  # the removed models leave no trace


def test_a_system_in_a_spawned_model_is_called_from_then_on(tmp_path: Any) -> None:
    (tmp_path / "spinner.py").write_text(
        "from gz.sim8 import Link, Model\nfrom gz.math7 import Vector3d\n\n"
        "class Spinner:\n    def configure(self, entity, sdf, ecm, e):\n"
        "        self.link = Link(Model(entity).canonical_link(ecm))\n"
        "    def pre_update(self, info, ecm):\n"
        "        self.link.set_angular_velocity(ecm, Vector3d(0, 0, 3))\n\n"
        "def get_system():\n    return Spinner()\n",
        encoding="utf-8",
    )
    ball = """<sdf version='1.9'><model name='ball'><link name='l'/>
      <plugin filename='gz-sim-python-system-loader-system' name='gz::sim::systems::PythonSystemLoader'>
      <module_name>spinner</module_name></plugin></model></sdf>"""
    with simkit.load(WORLD, plugin_paths=[tmp_path]) as sim:
        sim.step(5)
        sim.spawn(ball, name="top")
        sim.step(5)
        assert sim.link("top::l").angular_velocity == pytest.approx([0, 0, 3])
        sim.remove("top")
        sim.step(5)


def test_a_system_that_only_reads_changes_no_bit() -> None:
    class Watcher:
        def post_update(self, info: Any, ecm: Any) -> None:
            Link(5).enable_velocity_checks(ecm)
            Link(5).world_linear_velocity(ecm)
            Link(5).world_pose(ecm)

    ends = []
    for plugins in ([GzSystem(Pusher())], [GzSystem(Pusher()), GzSystem(Watcher())]):
        with simkit.load(WORLD, plugins=plugins) as sim:
            sim.step(50)
            ends.append(state(sim))
    assert np.array(ends[0]).tobytes() == np.array(ends[1]).tobytes()


def test_shutdown_is_called_at_the_end() -> None:
    pages: list[str] = []

    class Tidy:
        def shutdown(self) -> None:
            pages.append("down")

    with simkit.load(WORLD, plugins=[GzSystem(Tidy())]) as sim:
        sim.step()
    assert pages == ["down"]
