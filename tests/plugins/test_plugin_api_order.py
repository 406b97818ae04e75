"""Order of plugins: they are loaded and called in document order, whatever their parent."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import simkit
from simkit import WorldPlugin
from simkit.params import Params
from simkit.runtime import Simulation

LOG = """
from simkit import Plugin

CALLS = []

class Tell(Plugin):
    parent_kind = "any"

    def load(self, parent, params):
        CALLS.append(("load", self.name))

    def before_step(self):
        CALLS.append(("before", self.name))

    def after_step(self):
        CALLS.append(("after", self.name))
"""


def plugin(name: str) -> str:
    return f"<plugin name='{name}' filename='tell.py'/>"


def link(name: str, inside: str = "") -> str:
    return f"<link name='{name}'>{inside}</link>"


def sensor(name: str) -> str:
    return f"<sensor name='{name}' type='imu'>{plugin('sensor ' + name)}</sensor>"


def visual(name: str) -> str:
    ball = "<geometry><sphere><radius>0.1</radius></sphere></geometry>"
    return f"<visual name='{name}'>{ball}{plugin('visual ' + name)}</visual>"


def order(folder: Path, text: str, hook: str = "load", spawn: str = "") -> list[str]:
    (folder / "tell.py").write_text(LOG)
    with simkit.load(text, plugin_paths=[folder], resource_paths=[folder]) as sim:
        if spawn:
            sim.spawn(spawn)
        tell: Any = next(type(p) for p in sim.engine.structure.all_plugins() if type(p).__name__ == "Tell")
        calls = tell.load.__globals__["CALLS"]
        if hook != "load":
            del calls[:]
            sim.step()
        found = [name for h, name in calls if h == hook]
        del calls[:]
    return found


WORLD = (
    "<sdf version='1.9'><world name='w'>"
    + plugin("world first")
    + f"<model name='a'>{plugin('a first')}{link('l', visual('v') + sensor('s') + visual('u'))}"
    + f"<model name='n'>{link('m', sensor('t'))}{plugin('nested')}</model>{plugin('a last')}</model>"
    + plugin("world middle")
    + f"<model name='b'>{link('l', sensor('r'))}{plugin('b')}</model>"
    + plugin("world last")
    + "</world></sdf>"
)
WRITTEN = [
    "world first",
    "a first",
    "visual v",
    "sensor s",
    "visual u",
    "sensor t",
    "nested",
    "a last",
    "world middle",
    "sensor r",
    "b",
    "world last",
]


@pytest.mark.parametrize("hook", ["load", "before", "after"])
def test_world_model_nested_sensor_and_visual_plugins_run_in_document_order(tmp_path: Path, hook: str) -> None:
    assert order(tmp_path, WORLD, hook) == WRITTEN


def test_line_breaks_do_not_change_the_order(tmp_path: Path) -> None:
    assert order(tmp_path, WORLD.replace("><", ">\n<")) == WRITTEN


def test_plugins_of_an_included_model_have_the_position_of_the_include(tmp_path: Path) -> None:
    folder = tmp_path / "thing"
    folder.mkdir()
    model = f"<sdf version='1.9'><model name='thing'>{plugin('own')}{link('l', sensor('s'))}"
    (folder / "model.sdf").write_text(f"<!-- {'long ' * 50} -->\n" * 30 + model + "</model></sdf>")
    (folder / "model.config").write_text("<model><name>thing</name><sdf version='1.9'>model.sdf</sdf></model>")
    include = f"<include><uri>model://thing</uri>{plugin('added')}</include>"
    outer = f"<model name='outer'>{plugin('before')}<include><uri>model://thing</uri></include>{plugin('after')}"
    text = (
        f"<sdf version='1.9'><world name='w'>{plugin('first')}{include}{plugin('second')}{outer}{link('l')}</model>"
        f"{plugin('third')}</world></sdf>"
    )
    assert order(tmp_path, text) == [
        "first", "own", "sensor s", "added", "second", "before", "own", "sensor s", "after", "third",
    ]  # fmt: skip


def test_plugins_from_python_run_after_the_file_and_spawned_ones_last(tmp_path: Path) -> None:
    calls: list[str] = []

    class Made(WorldPlugin):
        def load(self, parent: Simulation, params: Params) -> None:
            pass

        def after_step(self) -> None:
            calls.append(self.label)

        def __init__(self, label: str) -> None:
            self.label = label

    (tmp_path / "tell.py").write_text(LOG)
    text = f"<sdf version='1.9'><world name='w'><model name='m'>{link('l')}{plugin('m')}</model></world></sdf>"
    with simkit.load(text, plugin_paths=[tmp_path], plugins=[Made("x"), Made("y")]) as sim:
        for name in ("z", "a"):
            sim.spawn(f"<sdf version='1.9'><model name='{name}'>{link('l')}{plugin(name)}</model></sdf>")
        loaded_names = [p.name for p in sim.engine.structure.all_plugins() if type(p).__name__ in ("Tell", "Made")]
        sim.step()
    assert loaded_names == ["m", "Made", "Made", "z", "a"]
    assert calls == ["x", "y"]


def test_reset_and_restore_keep_the_order(tmp_path: Path) -> None:
    (tmp_path / "tell.py").write_text(LOG)
    with simkit.load(WORLD, plugin_paths=[tmp_path]) as sim:

        def loaded_names() -> list[str]:
            return [p.name for p in sim.engine.structure.all_plugins() if type(p).__name__ == "Tell"]

        snapshot = sim.snapshot()
        sim.remove("a")
        assert loaded_names() == [
            n for n in WRITTEN if n in ("world first", "world middle", "sensor r", "b", "world last")
        ]
        sim.restore(snapshot)
        assert loaded_names() == WRITTEN
        sim.remove("b")
        sim.reset()
        assert loaded_names() == WRITTEN


def test_the_plugins_of_a_urdf_run_in_document_order(tmp_path: Path) -> None:
    urdf = (
        "<robot name='r'>"
        f"<gazebo>{plugin('one')}</gazebo>"
        "<link name='base'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/>"
        "</inertial></link>"
        f"<gazebo reference='base'>{sensor('two')}</gazebo>"
        f"<gazebo>{plugin('three')}</gazebo></robot>"
    )
    assert order(tmp_path, urdf) == ["one", "sensor two", "three"]
