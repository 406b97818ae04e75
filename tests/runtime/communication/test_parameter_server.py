"""Live parameters: types, bounds, and changes during the run."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import simkit
from simkit.errors import LoadError, ParameterError


class Tuner(simkit.WorldPlugin):
    def load(self, parent: Any, params: simkit.Params) -> None:
        self.gain = self.declare("p_gain", 2.0, minimum=0.0, maximum=100.0, description="gain [N·m/rad]")
        self.mode = self.declare("mode", "position", choices=("position", "velocity"))
        self.count = self.declare("count", 3, minimum=1)
        self.is_on = self.declare("on", False)
        self.offset = self.declare("offset", (0.0, 0.0, 0.0))
        self.seen: list[float] = []
        self.told: list[float] = []
        self.declare("speed", 1.0, on_change=self.told.append)

    def before_step(self) -> None:
        self.seen.append(self.gain.value)


def _tuner(sim: Any) -> Tuner:
    return next(plugin for plugin in sim.engine.structure.all_plugins() if isinstance(plugin, Tuner))


@pytest.fixture
def sim() -> Any:
    with simkit.load('<sdf version="1.9"><world name="w"/></sdf>', plugins=[Tuner()]) as sim:
        yield sim


def test_a_change_between_steps_is_effective_in_the_next_step(sim: Any) -> None:
    tuner = _tuner(sim)
    sim.step(2)
    sim.set_parameter("/Tuner", "p_gain", 5)
    assert sim.communication.parameters["/Tuner"]["p_gain"].value == 5.0
    sim.step(2)
    assert tuner.seen == [2.0, 2.0, 5.0, 5.0]


def test_the_plugin_is_notified_of_a_change(sim: Any) -> None:
    sim.set_parameter("/Tuner", "speed", 2.5)
    assert _tuner(sim).told == [2.5]


@pytest.mark.parametrize(
    ("name", "value", "allowed"),
    [
        ("p_gain", -1.0, "a number from 0 to 100"),
        ("p_gain", "much", "a number from 0 to 100"),
        ("p_gain", float("nan"), "a number from 0 to 100"),
        ("p_gain", True, "a number from 0 to 100"),
        ("mode", "speed", "one of 'position', 'velocity'"),
        ("count", 0, "an integer of at least 1"),
        ("count", 2.5, "an integer of at least 1"),
        ("on", 1, "a boolean"),
        ("offset", (1.0, 2.0), "3 numbers"),
        ("offset", (1.0, 2.0, "a"), "3 numbers"),
    ],
)
def test_an_invalid_value_changes_nothing_and_the_error_lists_the_allowed_values(
    sim: Any, name: str, value: Any, allowed: str
) -> None:
    before = sim.communication.parameters["/Tuner"][name].value
    with pytest.raises(ParameterError, match=f"expected {allowed}"):
        sim.set_parameter("/Tuner", name, value)
    assert sim.communication.parameters["/Tuner"][name].value == before


def test_the_error_for_an_unknown_node_or_parameter_suggests_the_closest_name(sim: Any) -> None:
    with pytest.raises(ParameterError, match="did you mean '/Tuner'"):
        sim.set_parameter("/Tunr", "p_gain", 1.0)
    with pytest.raises(ParameterError, match="did you mean 'p_gain'"):
        sim.set_parameter("/Tuner", "p_gian", 1.0)


def test_a_reset_and_a_restore_restore_the_values(sim: Any) -> None:
    sim.set_parameter("/Tuner", "p_gain", 7.0)
    sim.step()
    seven = sim.snapshot()
    sim.set_parameter("/Tuner", "p_gain", 9.0)
    sim.restore(seven)
    assert sim.communication.parameters["/Tuner"]["p_gain"].value == 7.0
    sim.reset()
    assert sim.communication.parameters["/Tuner"]["p_gain"].value == 2.0


def test_parameters_are_read_and_changed_by_the_services_of_ros(sim: Any) -> None:
    listed = sim.call("/Tuner/list_parameters").result.names
    assert listed == ["use_sim_time", "p_gain", "mode", "count", "on", "offset", "speed"]
    found = sim.call("/Tuner/get_parameters", {"names": ["p_gain", "mode", "nothing"]}).values
    assert [(v.type, v.double_value, v.string_value) for v in found] == [(3, 2.0, ""), (4, 0.0, "position"), (0, 0, "")]
    wanted = [
        {"name": "p_gain", "value": {"type": 3, "double_value": 4.0}},
        {"name": "count", "value": {"type": 2, "integer_value": 0}},
    ]
    results = sim.call("/Tuner/set_parameters", {"parameters": wanted}).results
    assert [r.successful for r in results] == [True, False]
    assert "an integer of at least 1" in results[1].reason
    assert sim.communication.parameters["/Tuner"]["p_gain"].value == 4.0
    wanted[0]["value"]["double_value"] = 8.0
    assert not sim.call("/Tuner/set_parameters_atomically", {"parameters": wanted}).result.successful
    assert sim.communication.parameters["/Tuner"]["p_gain"].value == 4.0
    described = sim.call("/Tuner/describe_parameters", {"names": ["p_gain"]}).descriptors[0]
    assert described.floating_point_range[0].to_value == 100.0
    assert described.description == "gain [N·m/rad]"


def test_the_initial_value_is_that_of_the_file(tmp_path: Any) -> None:
    (tmp_path / "tuner.py").write_text(
        "import simkit\n\n\nclass T(simkit.WorldPlugin):\n    filenames = ('libtuner.so',)\n\n"
        "    def load(self, parent, params):\n"
        "        self.declare('p_gain', 2.0, minimum=0.0, maximum=100.0)\n        self.declare('count', 3, minimum=1)\n"
        "        self.declare('gains', (1.0, 2.0), minimum=0.0)\n"
    )

    def world(content: str) -> str:
        plugin = f'<plugin name="tuner" filename="libtuner.so">{content}</plugin>'
        return f'<sdf version="1.9"><world name="w">{plugin}</world></sdf>'

    with simkit.load(world("<p_gain>5</p_gain><count>4</count>"), plugin_paths=[tmp_path]) as sim:
        values = {n: p.value for n, p in sim.communication.parameters["/tuner"].items()}
        assert values == {"p_gain": 5.0, "count": 4, "gains": (1.0, 2.0)}
    bad = "<p_gain>-5</p_gain><count>none</count><gains>1 -2</gains>"
    with pytest.raises(LoadError) as caught:
        simkit.load(world(bad), plugin_paths=[tmp_path])
    assert len([d for d in caught.value.diagnostics if d.code == "SK-PARAM-002"]) == 3


def test_a_model_may_reuse_the_node_of_a_removed_model_until_a_restore(
    tmp_path: Any,
) -> None:
    (tmp_path / "tuned.py").write_text(
        "import simkit\n\n\nclass T(simkit.ModelPlugin):\n    filenames = ('libtuned.so',)\n\n"
        "    def load(self, parent, params):\n"
        "        self.gains = [self.declare(name, 2.0) for name in ('p_gain', 'i_gain')]\n"
    )
    inertia = "<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>"
    plugin = '<plugin name="tuned" filename="libtuned.so"><p_gain>{}</p_gain></plugin>'
    model = f'<model name="m"><link name="l">{inertia}</link>{plugin}</model>'
    world = f'<sdf version="1.9"><world name="w">{model.format(3)}</world></sdf>'
    with simkit.load(world, plugin_paths=[tmp_path]) as sim:
        kept = sim.snapshot()
        sim.remove("m")
        assert not sim.communication.parameters
        sim.spawn(f'<sdf version="1.9">{model.format(5)}</sdf>', name="m")
        assert {n: p.value for n, p in sim.communication.parameters["/tuned"].items()} == {"p_gain": 5.0, "i_gain": 2.0}
        sim.restore(kept)
        sim.set_parameter("/tuned", "i_gain", 4.0)
        assert {n: p.value for n, p in sim.communication.parameters["/tuned"].items()} == {"p_gain": 3.0, "i_gain": 4.0}
        assert sim.call("/tuned/get_parameters", {"names": ["i_gain"]}).values[0].double_value == 4.0


@pytest.mark.parametrize(
    ("default", "value", "stored"),
    [
        (1.0, np.array([1.0, 2.0]), None),
        (1.0, 10**400, None),
        (1, 2**63, None),
        (1, 2**53 + 1, 2**53 + 1),
        (1, np.int64(4), 4),
        (False, np.bool_(True), True),
        ((1.0, 2.0), {3.0, 4.0}, None),
        ((1.0, 2.0), np.array([3, 4]), (3.0, 4.0)),
    ],
)
def test_unusual_values_are_accepted_unchanged_or_rejected(default: Any, value: Any, stored: Any) -> None:
    class One(simkit.WorldPlugin):
        def load(self, parent: Any, params: simkit.Params) -> None:
            self.value = self.declare("value", default)

    with simkit.load('<sdf version="1.9"><world name="w"/></sdf>', plugins=[One()]) as sim:
        if stored is None:
            with pytest.raises(ParameterError, match="One value: found .*; expected"):
                sim.set_parameter("/One", "value", value)
        else:
            sim.set_parameter("/One", "value", value)
        now = sim.communication.parameters["/One"]["value"].value
        assert now == (default if stored is None else stored) and type(now) is type(default)


def test_every_node_with_parameters_uses_simulated_time(sim: Any) -> None:
    names = sim.call("/Tuner/list_parameters").result.names
    assert names[0] == "use_sim_time" and "p_gain" in names
    value, *_ = sim.call("/Tuner/get_parameters", {"names": ["use_sim_time"]}).values
    assert (value.type, value.bool_value) == (1, True)
    sim.set_parameter("/Tuner", "use_sim_time", True)
    request = {"parameters": [{"name": "use_sim_time", "value": {"type": 1, "bool_value": False}}]}
    answer = sim.call("/Tuner/set_parameters", request).results[0]
    assert not answer.successful and "expected one of True" in answer.reason
    assert "use_sim_time" not in sim.communication.parameters["/Tuner"]


def test_declared_set_and_removed_parameters_are_events(sim: Any) -> None:
    heard = sim.subscribe("/parameter_events")
    sim.step(3)
    sim.set_parameter("/Tuner", "p_gain", 5)
    parameter = sim.declare("rate", 10, node="/mine")
    sim.communication.live_parameters.remove(parameter)
    changed, declared, removed = heard.messages
    assert (changed.node, changed.stamp.nanosec) == ("/Tuner", 3_000_000)
    assert [(p.name, p.value.type, p.value.double_value) for p in changed.changed_parameters] == [("p_gain", 3, 5.0)]
    assert [(p.name, p.value.integer_value) for p in declared.new_parameters] == [("rate", 10)]
    assert (removed.node, [p.name for p in removed.deleted_parameters]) == ("/mine", ["rate"])
    assert not removed.new_parameters and not removed.changed_parameters


def test_parameters_of_a_removed_model_are_deleted_and_come_back_with_a_restore() -> None:
    class Gain(simkit.ModelPlugin):
        def load(self, parent: Any, params: simkit.Params) -> None:
            self.gain = self.declare("gain", 1.0)

    text = '<sdf version="1.9"><world name="w"><model name="m"><link name="l"/></model></world></sdf>'
    with simkit.load(text, plugins=[("m", Gain())]) as sim:
        heard = sim.subscribe("/parameter_events")
        before = sim.snapshot()
        sim.remove("m")
        sim.restore(before)
    deleted, new = heard.messages
    assert [p.name for p in deleted.deleted_parameters] == [p.name for p in new.new_parameters] == ["gain"]
    assert deleted.node == new.node and not deleted.new_parameters and not new.deleted_parameters
