"""Times at which the hooks of a plugin are called, and the state of a plugin."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

import pytest
from plugin_worlds import GROUND, rover, world

import simkit
from simkit import Params, WorldPlugin


class Diary(WorldPlugin):
    """Records the times of its calls."""

    def __init__(self, before: float | None = None, after: float | None = None) -> None:
        self.before_step_rate, self.after_step_rate = before, after

    def load(self, parent: Any, params: Params) -> None:
        self.entries: list[tuple[str, float]] = [("load", parent.time)]

    def reset(self) -> None:
        self.entries.append(("reset", self.sim.time))

    def before_step(self) -> None:
        self.entries.append(("before", self.sim.time))

    def after_step(self) -> None:
        self.entries.append(("after", self.sim.time))

    def close(self) -> None:
        self.entries.append(("close", self.sim.time))

    def times(self, hook: str) -> list[float]:
        return [round(t, 6) for h, t in self.entries if h == hook]


def opened(plugin: simkit.Plugin, *parts: str) -> simkit.Simulation:
    return simkit.load(world(GROUND, *parts), plugins=[plugin])


def test_without_a_rate_hooks_run_before_and_after_every_step() -> None:
    diary = Diary()
    with opened(diary) as sim:
        sim.step(3)
    assert diary.entries[:3] == [("load", 0.0), ("before", 0.0), ("after", 0.001)]
    assert diary.times("before") == [0.0, 0.001, 0.002]
    assert diary.times("after") == [0.001, 0.002, 0.003]
    assert diary.entries[-1][0] == "close"


def test_with_a_rate_they_run_at_the_first_step_at_or_after_each_period() -> None:
    diary = Diary(before=30, after=30)
    with opened(diary) as sim:
        sim.run(0.11)
    assert diary.times("after") == [0.034, 0.067, 0.1]
    assert diary.times("before")[-2:] == [0.067, 0.1]


def test_a_rate_changed_in_a_hook_applies_after_a_reschedule_and_is_restored() -> None:
    class Slower(Diary):
        def after_step(self) -> None:
            super().after_step()
            if self.sim.tick == 3:
                self.after_step_rate = 100
                self.sim.engine.reschedule()

    slower = Slower()
    with opened(slower) as sim:
        for _ in range(2):
            sim.run(0.03)
            assert slower.times("after") == [0.001, 0.002, 0.003, 0.01, 0.02, 0.03]
            sim.reset()


def test_reset_brings_back_the_attributes_of_load_and_then_calls_the_hook() -> None:
    diary = Diary()
    with opened(diary) as sim:
        sim.run(0.1)
        sim.reset()
        assert diary.entries == [("load", 0.0), ("reset", 0.0)]


def test_restore_brings_back_the_attributes_and_drops_later_ones() -> None:
    diary = Diary()
    with opened(diary) as sim:
        sim.step(2)
        snapshot, entries = sim.snapshot(), list(diary.entries)
        for _ in range(2):
            sim.step(3)
            diary.later = 1  # type: ignore[attr-defined]
            sim.restore(snapshot)
            assert diary.entries == entries
            assert not hasattr(diary, "later")


def test_handles_publishers_and_methods_in_attributes_survive_a_restore() -> None:
    class Holder(Diary):
        def load(self, parent: Any, params: Params) -> None:
            super().load(parent, params)
            self.model = parent.model("rover")
            self.out = self.advertise("out", "std_msgs/msg/Float64")
            self.call = self.after_step

    holder = Holder()
    with opened(holder, rover()) as sim:
        model, out = holder.model, holder.out
        sim.restore(sim.snapshot())
        assert holder.model is model and holder.out is out
        assert holder.call.__self__ is holder


def test_an_attribute_that_cannot_be_copied_is_reported_once_and_not_changed() -> None:
    class Locked(Diary):
        def load(self, parent: Any, params: Params) -> None:
            super().load(parent, params)
            self.lock = threading.Lock()

    locked = Locked()
    with opened(locked) as sim:
        lock = locked.lock
        for _ in range(3):
            sim.restore(sim.snapshot())
        assert locked.lock is lock
        assert locked.entries == [("load", 0.0)]
        found = [d for d in sim.diagnostics if d.code == "SK-PLUGIN-006"]
    assert len(found) == 1 and "'lock'" in found[0].message


def test_a_hook_that_raises_stops_the_run_with_its_name_and_time() -> None:
    class Faulty(Diary):
        def after_step(self) -> None:
            if self.sim.time > 0.0045:
                raise ZeroDivisionError("too far")

    with opened(Faulty()) as sim, pytest.raises(simkit.PluginError) as caught:
        sim.run(1.0)
    assert (caught.value.plugin, caught.value.hook) == ("Faulty", "after_step")
    assert caught.value.time == pytest.approx(0.005)
    assert isinstance(caught.value.__cause__, ZeroDivisionError)


def test_a_hook_cannot_step_its_own_simulation() -> None:
    class Hasty(Diary):
        def after_step(self) -> None:
            self.sim.step()

    with opened(Hasty()) as sim:
        with pytest.raises(simkit.PluginError, match="the simulation is already stepping"):
            sim.run(1.0)
        assert sim.tick == 1


def test_an_unread_parameter_is_a_warning_with_the_closest_name_that_was_read() -> None:
    body = "<light_name>sun</light_name><update_rte>3</update_rte>"
    plugin = f"<plugin name='solar' filename='libsolar_sensor.so'>{body}</plugin>"
    light = "<light name='sun' type='point'><pose>0 0 9 0 0 0</pose></light>"
    with simkit.load(world(light, rover(plugin))) as sim:
        found = [d for d in sim.diagnostics if d.code == "SK-PARAM-003"]
    assert len(found) == 1
    assert "update_rte" in found[0].message and "update_rate" in found[0].hint


def test_systems_that_are_not_needed_are_a_note() -> None:
    plugin = "<plugin filename='gz-sim-physics-system' name='gz::sim::systems::Physics'><engine/></plugin>"
    with simkit.load(world(GROUND, plugin)) as sim:
        found = [(d.code, d.severity) for d in sim.diagnostics if "Physics" in d.message]
    assert found == [("SK-PLUGIN-005", "note")]


def test_an_unknown_plugin_does_not_stop_the_run() -> None:
    with simkit.load(world(GROUND, "<plugin name='x' filename='libgazebo_tutorials.so'/>")) as sim:
        sim.run(0.1)
        found = [(d.code, d.severity) for d in sim.diagnostics if "libgazebo_tutorials.so" in d.message]
    assert found == [("SK-PLUGIN-001", "warning")]


@pytest.mark.parametrize("outer", [False, True])
def test_a_driving_plugin_on_a_static_model_is_ignored(outer: bool) -> None:
    plugins = {
        "gz-sim-diff-drive-system": "<left_joint>j</left_joint><right_joint>j</right_joint>",
        "libgazebo_ros_diff_drive.so": "<left_joint>j</left_joint><right_joint>j</right_joint>",
        "gz-sim-joint-controller-system": "<joint_name>j</joint_name>",
    }
    text = "".join(f'<plugin filename="{file}" name="{file}">{inner}</plugin>' for file, inner in plugins.items())
    links = '<link name="l"/><link name="k"/><joint name="j" type="revolute"><parent>l</parent><child>k</child><axis/>'
    model = f'<model name="m"><static>{not outer}</static>{links}</joint>{text}</model>'
    if outer:
        model = f'<model name="o"><static>1</static><link name="l"/>{model}</model>'
    with simkit.load(world(model)) as sim:
        sim.step(10)
        assert [d.code for d in sim.diagnostics if d.severity != "note"] == ["SK-PLUGIN-010"] * len(plugins)


class Pusher(WorldPlugin):
    """Has the names of hooks of other simulators, a misspelled one, and a callback with such a name."""

    def load(self, parent: Any, params: Params) -> None:
        self.listen("/push", "std_msgs/msg/Empty", self.on_update)

    def pre_step(self) -> None: ...

    def PostUpdate(self) -> None: ...

    def after_stp(self) -> None: ...

    def on_update(self, message: object) -> None: ...


class Puller(Pusher):
    """Has the hooks, so that the others may be helpers."""

    def before_step(self) -> None: ...

    def after_step(self) -> None: ...


def test_a_method_that_looks_like_a_hook_and_is_never_called_is_reported() -> None:
    with opened(Pusher()) as sim:
        found = [(d.message, d.hint) for d in sim.diagnostics if d.code == "SK-PLUGIN-013"]
    assert [message.rpartition(" ")[2] for message, _ in found] == [
        "Pusher.pre_step",
        "Pusher.PostUpdate",
        "Pusher.after_stp",
    ]
    assert [text.partition(",")[0] for _, text in found] == [
        "rename it to before_step",
        "rename it to after_step",
        "rename it to after_step",
    ]
    with opened(Puller()) as sim:
        assert not [d for d in sim.diagnostics if d.code == "SK-PLUGIN-013"]


def test_so_is_a_method_of_a_plugin_in_a_file(tmp_path: Path) -> None:
    code = """from simkit import WorldPlugin


class Push(WorldPlugin):
    def load(self, sim, params):
        self.listen("/push", "std_msgs/msg/Empty", self.on_update)

    def on_update(self, message): ...

    def pre_step(self): ...
"""
    (tmp_path / "push.py").write_text(code, encoding="utf-8")
    with simkit.load(world(GROUND, '<plugin filename="push.py" name="Push"/>'), plugin_paths=[tmp_path]) as sim:
        found = [d.message for d in sim.diagnostics if d.code == "SK-PLUGIN-013"]
    assert found == ["plugin 'Push': simkit does not call Push.pre_step"]
