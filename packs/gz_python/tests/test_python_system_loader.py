"""Worlds that name Python systems with `PythonSystemLoader`."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest

import simkit

WORLD = """<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity>
  <model name="body"><pose>0 0 10 0 0 0</pose>
    <link name="link"><inertial><mass>1</mass>
      <inertia><ixx>0.4</ixx><iyy>0.4</iyy><izz>0.4</izz></inertia></inertial></link>
    <plugin filename="{filename}" name="gz::sim::systems::PythonSystemLoader">
      <module_name>{module}</module_name>{more}
    </plugin>
  </model></world></sdf>"""

PUSHER = """
from {math} import Vector3d
from {sim} import Link, Model


class Pusher:
    def configure(self, entity, sdf, ecm, event_mgr):
        self.model = Model(entity)
        self.link = Link(self.model.canonical_link(ecm))
        self.force = sdf.get_double("force")
        self.steps = 0

    def pre_update(self, info, ecm):
        if info.paused:
            return
        self.steps += 1
        if info.iterations % 10 == 0:
            self.link.add_world_force(ecm, Vector3d(0, 0, self.force))


def get_system():
    return Pusher()
"""


def world(module: str, more: str = "", filename: str = "gz-sim-python-system-loader-system") -> str:
    return WORLD.format(module=module, more=more, filename=filename)


def write(folder: Path, name: str, text: str) -> None:
    file = folder / name
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text, encoding="utf-8")


def codes(sim: Any) -> list[str]:
    return [d.code for d in sim.diagnostics if d.severity != "note"]


@pytest.mark.parametrize(
    ("math", "sim"),
    [("gz.math7", "gz.sim8"), ("gz.math", "gz.sim"), ("ignition.math6", "ignition.gazebo6"), ("gz.math9", "gz.sim10")],
)
def test_a_system_pushes_its_model_whatever_version_it_imports(tmp_path: Path, math: str, sim: str) -> None:
    write(tmp_path, "pusher.py", PUSHER.format(math=math, sim=sim))
    with simkit.load(world("pusher", "<force>500</force>"), plugin_paths=[tmp_path]) as run:
        assert codes(run) == []
        run.run(0.1)
        assert run.link("body::link").linear_velocity == pytest.approx([0, 0, 10 * 500 * 0.001])


@pytest.mark.parametrize(
    "filename",
    ["libgz-sim-python-system-loader-system.so", "gz-sim8-python-system-loader-system"],
)
def test_every_spelling_of_the_library_is_known(tmp_path: Path, filename: str) -> None:
    text = "class Idle:\n    def update(self, info, ecm): ...\n\ndef get_system():\n    return Idle()\n"
    write(tmp_path, "idle.py", text)
    with simkit.load(world("idle", filename=filename), plugin_paths=[tmp_path]) as run:
        assert codes(run) == []


@pytest.mark.parametrize("variable", ["GZ_SIM_SYSTEM_PLUGIN_PATH", "PYTHONPATH"])
def test_folders_in_the_environment_variables_are_searched(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, variable: str
) -> None:
    write(tmp_path, "pusher.py", PUSHER.format(math="gz.math", sim="gz.sim"))
    monkeypatch.setenv(variable, str(tmp_path))
    with simkit.load(world("pusher", "<force>500</force>")) as run:
        run.run(0.01)
        assert run.link("body::link").linear_velocity[2] == pytest.approx(0.5)


def test_a_module_next_to_the_world_is_not_run_unless_allowed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("PYTHONPATH", raising=False)
    write(tmp_path, "pusher.py", "raise SystemExit('it was run')\n\ndef get_system(): ...\n")
    write(tmp_path, "w.sdf", world("pusher", "<force>500</force>"))
    with pytest.raises(simkit.LoadError, match="SK-PLUGIN-080") as refused:
        simkit.load("w.sdf")
    (found,) = [d for d in refused.value.diagnostics if d.severity == "error"]
    assert "`--plugin-path .`" in found.hint and found.line == 5


def test_a_file_without_get_system_is_not_run(tmp_path: Path) -> None:
    write(tmp_path, "tool.py", "raise SystemExit('it was run')\n")
    with pytest.raises(simkit.LoadError, match="SK-PLUGIN-081.*has no function get_system"):
        simkit.load(world("tool"), plugin_paths=[tmp_path])


def test_a_link_out_of_the_allowed_folder_is_not_followed(tmp_path: Path) -> None:
    write(tmp_path, "outside/evil.py", "def get_system(): raise SystemExit\n")
    (tmp_path / "allowed").mkdir()
    (tmp_path / "allowed" / "evil.py").symlink_to(tmp_path / "outside" / "evil.py")
    with pytest.raises(simkit.LoadError, match="SK-PLUGIN-080"):
        simkit.load(world("evil"), plugin_paths=[tmp_path / "allowed"])


@pytest.mark.parametrize("name", ["../evil", "pusher.py/x", "a..b", "os;x"])
def test_an_invalid_module_name_is_an_error(tmp_path: Path, name: str) -> None:
    with pytest.raises(simkit.LoadError, match="SK-PLUGIN-080.*is not the name of a Python module"):
        simkit.load(world(name), plugin_paths=[tmp_path])


def test_a_missing_module_name_is_an_error() -> None:
    text = world("x").replace("<module_name>x</module_name>", "")
    with pytest.raises(simkit.LoadError, match="SK-PARAM-001.*<module_name>"):
        simkit.load(text)


def test_the_error_of_a_failing_module_has_its_line(tmp_path: Path) -> None:
    write(tmp_path, "broken.py", "import math\nx = 1 / 0\n\ndef get_system(): ...\n")
    with pytest.raises(simkit.LoadError, match=r"SK-PLUGIN-082.*broken\.py:2 failed: ZeroDivisionError"):
        simkit.load(world("broken"), plugin_paths=[tmp_path])


def test_a_module_with_a_syntax_error_is_reported(tmp_path: Path) -> None:
    write(tmp_path, "broken.py", "def get_system(:\n")
    with pytest.raises(simkit.LoadError, match=r"SK-PLUGIN-082.*SyntaxError"):
        simkit.load(world("broken"), plugin_paths=[tmp_path])


def test_an_unsupported_gazebo_module_is_reported_by_name(tmp_path: Path) -> None:
    write(tmp_path, "picture.py", "from gz.rendering8 import Scene\n\ndef get_system(): ...\n")
    with pytest.raises(
        simkit.LoadError, match=r"simkit has no gz\.rendering8; supported modules of Gazebo: common, math"
    ):
        simkit.load(world("picture"), plugin_paths=[tmp_path])


def test_get_system_must_return_an_object_with_a_hook(tmp_path: Path) -> None:
    write(tmp_path, "nothing.py", "def get_system():\n    return None\n")
    with pytest.raises(simkit.LoadError, match=r"SK-PLUGIN-084.*returns NoneType, which has no hook"):
        simkit.load(world("nothing"), plugin_paths=[tmp_path])


FAULTY = """
class Faulty:
    def {hook}(self, *args):
        raise ValueError("the wheel fell off")

def get_system():
    return Faulty()
"""


@pytest.mark.parametrize("hook", ["pre_update", "update", "post_update"])
def test_a_hook_that_raises_stops_the_run_with_its_line(tmp_path: Path, hook: str) -> None:
    write(tmp_path, "faulty.py", FAULTY.format(hook=hook))
    with simkit.load(world("faulty"), plugin_paths=[tmp_path]) as run:
        pattern = rf"in {hook} at .*faulty\.py:4 at t=.*the wheel fell off"
        with pytest.raises(simkit.PluginError, match=pattern) as raised:
            run.run(0.1)
        assert raised.value.exit_code == 4


def test_a_configure_that_raises_stops_the_load(tmp_path: Path) -> None:
    write(tmp_path, "faulty.py", FAULTY.format(hook="configure"))
    with pytest.raises(simkit.PluginError, match=r"raised in configure at .*faulty\.py:4 at t=0 s.*the wheel fell off"):
        simkit.load(world("faulty"), plugin_paths=[tmp_path])


def test_a_system_that_raises_can_be_disabled(tmp_path: Path) -> None:
    write(tmp_path, "faulty.py", FAULTY.format(hook="update"))
    text = world("faulty", "<simkit:on_error>disable</simkit:on_error>")
    with simkit.load(text, plugin_paths=[tmp_path]) as run:
        run.run(0.1)
        assert codes(run) == ["SK-PLUGIN-020"]


def test_a_package_and_its_neighbours_can_be_imported(tmp_path: Path) -> None:
    write(tmp_path, "robots/__init__.py", "")
    write(tmp_path, "robots/strength.py", "FORCE = 250.0\n")
    write(tmp_path, "beside_it.py", "TWICE = 2.0\n")
    text = PUSHER.format(math="gz.math", sim="gz.sim")
    text = text.replace('sdf.get_double("force")', "FORCE * TWICE")
    write(tmp_path, "robots/pusher.py", "from .strength import FORCE\nfrom beside_it import TWICE\n" + text)
    with simkit.load(world("robots.pusher"), plugin_paths=[tmp_path]) as run:
        run.run(0.01)
        assert run.link("body::link").linear_velocity[2] == pytest.approx(0.5)
    assert str(tmp_path) not in sys.path


def test_no_gazebo_module_stays_in_sys_modules(tmp_path: Path) -> None:
    before = list(sys.meta_path)
    write(tmp_path, "pusher.py", PUSHER.format(math="gz.math", sim="gz.sim"))
    with simkit.load(world("pusher", "<force>5</force>"), plugin_paths=[tmp_path]) as run:
        run.run(0.02)
    assert sys.meta_path == before
    assert not [name for name in sys.modules if name.split(".")[0] in ("gz", "ignition", "sdformat")]


def test_a_hook_may_import_gazebos_modules_when_it_runs(tmp_path: Path) -> None:
    late = """
class Late:
    def pre_update(self, info, ecm):
        from gz.math7 import Vector3d
        from gz.sim8 import World, world_entity

        assert World(world_entity(ecm)).gravity(ecm) == Vector3d(0, 0, 0)

def get_system():
    return Late()
"""
    write(tmp_path, "late.py", late)
    with simkit.load(world("late"), plugin_paths=[tmp_path]) as run:
        run.run(0.01)


PLAIN = """
import sys

steps = 0

def pre_update(info, ecm):
    global steps
    steps += 1

def get_system():
    return sys.modules[__name__]
"""


def test_a_module_without_a_class_is_a_system_by_itself(tmp_path: Path) -> None:
    write(tmp_path, "plain.py", PLAIN)
    with simkit.load(world("plain"), plugin_paths=[tmp_path]) as run:
        run.run(0.01)
        (loader,) = [p for p in run.engine.structure.all_plugins() if getattr(p, "is_gz_system", False)]
        assert loader.system.steps == 10
        run.reset()
        assert loader.system.steps == 0


def test_a_misspelt_element_is_reported_with_the_closest_element_that_was_read(tmp_path: Path) -> None:
    write(tmp_path, "pusher.py", PUSHER.format(math="gz.math", sim="gz.sim"))
    with simkit.load(world("pusher", "<forze>5</forze>"), plugin_paths=[tmp_path]) as run:
        (found,) = [d for d in run.diagnostics if d.code == "SK-PARAM-003"]
        assert "force" in found.hint


def test_an_invalid_number_in_the_file_is_an_error_of_the_file(tmp_path: Path) -> None:
    write(tmp_path, "pusher.py", PUSHER.format(math="gz.math", sim="gz.sim"))
    with pytest.raises(simkit.LoadError, match="SK-PARAM-002.*<force>strong</force>"):
        simkit.load(world("pusher", "<force>strong</force>"), plugin_paths=[tmp_path])


def test_a_system_can_belong_to_the_world_or_to_a_sensor(tmp_path: Path) -> None:
    teller = """
class Teller:
    def configure(self, entity, sdf, ecm, event_mgr):
        self.entity, self.name = entity, sdf.get_name()

def get_system():
    return Teller()
"""
    write(tmp_path, "teller.py", teller)
    plugin = '<plugin filename="gz-sim-python-system-loader-system" name="gz::sim::systems::PythonSystemLoader"><module_name>teller</module_name></plugin>'  # noqa: E501
    text = f"""<sdf version="1.9"><world name="w">{plugin}<model name="m"><link name="l">
      <sensor name="s" type="imu"><update_rate>10</update_rate>{plugin}</sensor></link></model></world></sdf>"""
    with simkit.load(text, plugin_paths=[tmp_path]) as run:
        loaders = [p for p in run.engine.structure.all_plugins() if getattr(p, "is_gz_system", False)]
        assert sorted(p.system.entity for p in loaders) == [1, 6]
        assert {p.system.name for p in loaders} == {"plugin"}
