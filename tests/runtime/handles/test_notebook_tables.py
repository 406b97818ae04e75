"""Tables of models and worlds in notebooks."""

import simkit

WORLD = """<sdf version="1.9"><world name="yard"><model name="arm&amp;co"><pose>1 2 0 0 0 0</pose>
<link name="base"><inertial><mass>1</mass></inertial></link>
<link name="tip"><inertial><mass>1</mass></inertial></link>
<joint name="fixed" type="fixed"><parent>world</parent><child>base</child></joint>
<joint name="turn" type="revolute"><parent>base</parent><child>tip</child><axis><xyz>0 0 1</xyz></axis></joint></model>
<model name="wall"><static>true</static><link name="l"/></model></world></sdf>"""


def test_a_world_is_a_table_of_its_models_and_a_model_one_of_its_movable_joints():
    with simkit.load(WORLD) as sim:
        model = sim.model("arm&co")
        model.joint("turn").set_position(0.25)
        world, arm = sim._repr_html_(), model._repr_html_()
        assert "<td>arm&amp;co</td><td>x 1.000, y 2.000, z 0.000 m, yaw 0.0°</td><td>2</td><td>2</td>" in world
        assert "<td>wall</td><td>static</td>" in world
        assert "<td>turn</td><td>revolute</td><td>0.250</td><td>0.000</td>" in arm and "<td>fixed</td>" not in arm
        assert "<table>" not in sim.model("wall")._repr_html_()
    assert "removed" in model._repr_html_() and "closed" in sim._repr_html_()
