"""Kinds of plugins and their sources: classes, objects and modules, from files and from Python."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from plugin_worlds import GROUND, rover, world

import simkit
from simkit import ModelPlugin, Params, SensorPlugin, VisualPlugin, WorldPlugin
from simkit.runtime import Simulation

BALL = "<model name='ball'><pose>0 0 1 0 0 0</pose><link name='l'>{}</link></model>"

HOOKS = """
class Counter:
    def __init__(self):
        self.told = []
        self.steps = 0

    def configure(self, entity, sdf, ecm, events):
        self.told.append(("configure", sdf.get_string("word") if sdf.has_element("word") else ""))

    def pre_update(self, info, ecm):
        self.told.append(("pre_update", info.iterations))

    def update(self, info, ecm):
        self.told.append(("update", info.iterations))

    def post_update(self, info, ecm):
        self.steps += 1
        self.told.append(("post_update", info.iterations))

    def reset(self, info, ecm):
        self.told.append(("reset", info.iterations))
"""
FUNCTIONS = """
TOLD = []

def configure(entity, sdf, ecm, events):
    TOLD.append(("configure", ""))

def pre_update(info, ecm):
    TOLD.append(("pre_update", info.iterations))
"""
GIVER = (
    HOOKS
    + """
def get_system():
    return Counter()
"""
)
STEP = [("pre_update", 1), ("update", 1), ("post_update", 1)]


def module_of(tmp_path: Path, text: str, name: str) -> ModuleType:
    file = tmp_path / f"{name}.py"
    file.write_text(text)
    spec = importlib.util.spec_from_file_location(name, file)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


def system(sim: Simulation) -> Any:
    return next(p.system for p in sim.engine.structure.all_plugins() if getattr(p, "is_gz_system", False))


def told(sim: Simulation) -> list[Any]:
    found = system(sim)
    return list(found.TOLD if isinstance(found, ModuleType) else found.told)


@pytest.mark.needs_packs
@pytest.mark.parametrize("way", ["file", "named", "class", "giver", "functions", "alias"])
def test_classes_and_modules_with_the_hooks_of_gz_are_found_like_other_plugins(tmp_path: Path, way: str) -> None:
    names = {
        "file": ("counter.py", HOOKS),
        "named": ("counter.py", HOOKS + "class Other(Counter): pass\n"),
        "class": ("robots.counter:Counter", HOOKS),
        "giver": ("counter.py", GIVER),
        "functions": ("counter.py", FUNCTIONS),
        "alias": (
            "libcounter.so",
            HOOKS.replace("class Counter:", "class Counter:\n    filenames = ('libcounter.so',)"),
        ),
    }
    filename, text = names[way]
    if way == "class":
        (tmp_path / "robots").mkdir()
        (tmp_path / "robots" / "counter.py").write_text(text)
    else:
        (tmp_path / "counter.py").write_text(text)
    word = "" if way == "functions" else "<word>hello</word>"
    plugin = f"<plugin name='Counter' filename='{filename}'>{word}</plugin>"
    with simkit.load(world(GROUND, plugin), plugin_paths=[tmp_path]) as sim:
        assert not [d for d in sim.diagnostics if d.severity == "warning"]
        sim.step()
        steps = STEP[:1] if way == "functions" else STEP
        assert told(sim) == [("configure", "hello" if word else ""), *steps]
        assert sim.contents.plugins["Counter"].where.line


def test_a_file_alone_runs_no_code(tmp_path: Path) -> None:
    (tmp_path / "counter.py").write_text("raise SystemError\n")
    file = tmp_path / "w.sdf"
    file.write_text(world(GROUND, "<plugin name='c' filename='counter.py'/>"))
    with pytest.raises(simkit.LoadError, match="w.sdf:.*SK-PLUGIN-001.*'counter.py' is not found"):
        simkit.load(file)


@pytest.mark.needs_packs
@pytest.mark.parametrize("point", ["mypack:Counter", "mypack"])
@pytest.mark.parametrize("filename", ["mypack:Counter", "libcounter.so"])
def test_an_entry_point_is_found_by_its_name_and_by_its_value(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, point: str, filename: str
) -> None:
    if point == "mypack" and filename != "libcounter.so":
        return
    (tmp_path / "mypack.py").write_text(GIVER)
    info = tmp_path / "mypack-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: mypack\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(f"[simkit.plugins]\ncounter = {point}\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.delitem(sys.modules, "mypack", raising=False)
    with simkit.load(world(GROUND, f"<plugin name='c' filename='{filename}'/>")) as sim:
        sim.step()
        assert told(sim)[1:] == STEP
    monkeypatch.delitem(sys.modules, "mypack", raising=False)
    (tmp_path / "mypack.py").write_text("import no_such_thing\n")
    with pytest.raises(simkit.LoadError, match="SK-PLUGIN-008.*no_such_thing"):
        simkit.load(world(GROUND, f"<plugin name='c' filename='{filename}'/>"))


@pytest.mark.needs_packs
def test_a_plugin_from_python_may_be_a_class_an_object_or_a_module(tmp_path: Path) -> None:
    module = module_of(tmp_path, GIVER, "api_giver")
    functions = module_of(tmp_path, FUNCTIONS, "api_functions")
    for made in (module.Counter, module.Counter(), module, functions):
        with simkit.load(world(GROUND), plugins=[made]) as sim:
            sim.step()
            assert told(sim)[:2] == [("configure", ""), ("pre_update", 1)]


@pytest.mark.needs_packs
def test_the_attributes_of_a_gz_object_are_its_state(tmp_path: Path) -> None:
    module = module_of(tmp_path, HOOKS, "api_state")
    with simkit.load(world(GROUND), plugins=[module.Counter()]) as sim:
        sim.step(3)
        snapshot = sim.snapshot()
        sim.step(4)
        assert system(sim).steps == 7
        sim.restore(snapshot)
        assert system(sim).steps == 3
        sim.reset()
        assert system(sim).steps == 0 and told(sim)[-1][0] == "reset"


@pytest.mark.needs_packs
def test_a_gz_plugin_that_raises_may_be_disabled(tmp_path: Path) -> None:
    text = HOOKS.replace("        self.steps += 1", "        self.steps += 1\n        assert self.steps < 3, 'enough'")
    module = module_of(tmp_path, text, "api_raiser")
    with simkit.load(world(GROUND), plugins=[module.Counter()], on_error="disable") as sim:
        sim.step(5)
        assert system(sim).steps == 3
        (found,) = [d.message for d in sim.diagnostics if d.code == "SK-PLUGIN-020"]
        assert "AssertionError: enough" in found and "post_update" in found
    with (
        simkit.load(world(GROUND), plugins=[module.Counter()]) as sim,
        pytest.raises(simkit.PluginError, match="enough"),
    ):
        sim.step(5)


@pytest.mark.needs_packs
def test_an_object_that_is_not_a_plugin_is_an_error_that_lists_the_allowed_objects() -> None:
    with pytest.raises(simkit.LoadError, match="SK-PLUGIN-022.*pre_update"):
        simkit.load(world(GROUND), plugins=["counter", 3])
    with pytest.raises(simkit.LoadError, match="SK-PLUGIN-022"):
        simkit.load(world(GROUND), plugins=[ModelPlugin])


# ---------------------------------------------------------------------- made in Python


class Gain(WorldPlugin):
    def load(self, parent: Simulation, params: Params) -> None:
        self.gain = params.number("gain", 1.0, minimum=0)
        self.topic = params.text("topic", "out")
        self.limits = params.block("limits").vector("xyz", 3, (0, 0, 0))
        self.on = params.boolean("on", False)
        self.called = [one.value for one in params.all("name")]


def test_keyword_arguments_are_read_like_parameters_of_a_file() -> None:
    plugin = Gain(gain=2, topic="there", limits={"xyz": (1, 2.5, 3)}, on=True, name=["a", "b"])
    with simkit.load(world(GROUND), plugins=[plugin]) as sim:
        assert (plugin.gain, plugin.topic, plugin.limits, plugin.on) == (2.0, "there", (1.0, 2.5, 3.0), True)
        assert plugin.called == ["a", "b"]
        sim.run(0.01)
        sim.reset()
        assert plugin.gain == 2.0


def test_invalid_keyword_arguments_are_reported_like_parameters_of_a_file() -> None:
    with pytest.raises(simkit.LoadError, match="at least 0"):
        simkit.load(world(GROUND), plugins=[Gain(gain=-1)])
    with simkit.load(world(GROUND), plugins=[Gain(gian=1)]) as sim:
        (found,) = [d for d in sim.diagnostics if d.code == "SK-PARAM-003"]
    assert "<gian>" in found.message and found.hint == "did you mean 'gain'?"


class OnModel(ModelPlugin):
    parent: Any

    def load(self, parent: Any, params: Params) -> None:
        self.parent = parent


class OnSensor(SensorPlugin):
    def load(self, parent: Any, params: Params) -> None:
        self.parent = parent


class OnVisual(VisualPlugin):
    def load(self, parent: Any, params: Params) -> None:
        self.parent = parent


SEEN = "<visual name='v'><geometry><sphere><radius>0.1</radius></sphere></geometry></visual>"
FELT = "<sensor name='s' type='imu'/>"


def test_a_model_plugin_is_attached_to_the_named_or_to_the_only_model() -> None:
    only, first, second = OnModel(), OnModel(), OnModel()
    with simkit.load(world(GROUND, BALL.format("")), plugins=[only]):
        assert only.parent.name == "ball" and only.scoped == "ball"
    with simkit.load(world(GROUND, BALL.format(""), rover()), plugins=[("rover", first), ("ground", second)]) as sim:
        assert (first.parent.name, second.parent.name) == ("rover", "ground")
        sim.remove("rover")
        assert first not in sim.engine.structure.all_plugins()
    with pytest.raises(simkit.LoadError, match=r"SK-PLUGIN-021.*'ground', 'ball', 'rover'"):
        simkit.load(world(GROUND, BALL.format(""), rover()), plugins=[OnModel()])
    with pytest.raises(simkit.LoadError, match="did you mean 'rover'"):
        simkit.load(world(GROUND, rover()), plugins=[("rovre", OnModel())])


def test_sensor_and_visual_plugins_are_attached_to_the_named_or_to_the_only_entity() -> None:
    sensor, visual = OnSensor(), OnVisual()
    with simkit.load(world(GROUND, BALL.format(SEEN + FELT)), plugins=[sensor, ("ball::l::v", visual)]):
        assert sensor.parent.scoped == "ball::l::s"
        assert visual.parent.name == "v"


@pytest.mark.parametrize("rate", [-1.0, float("nan"), float("inf")])
def test_an_invalid_rate_is_an_error(rate: float) -> None:
    class Odd(WorldPlugin):
        after_step_rate = rate

        def load(self, parent: Simulation, params: Params) -> None:
            pass

        def after_step(self) -> None:
            pass

    with pytest.raises(simkit.LoadError, match="SK-PLUGIN-023.*after_step_rate"):
        simkit.load(world(GROUND), plugins=[Odd()])
