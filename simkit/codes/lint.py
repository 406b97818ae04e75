"""Codes of the physics lint of `simkit check`."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import INERTIAL, link, model, sensor, world

_BOX = '<collision name="hull"><geometry><box><size>{0} {0} {0}</size></box></geometry></collision>'
_LOOK = '<visual name="look"><geometry><box><size>{0} {0} {0}</size></box></geometry></visual>'
_FALLING = f"""
<physics name="coarse" type="ode"><max_step_size>0.02</max_step_size></physics>
<model name="box"><link name="body">
  {INERTIAL}
  {_BOX.format(1)}
</link></model>
"""
_ARM = f"""
<link name="base">{INERTIAL}</link>
<link name="arm">
  <inertial><mass>0.1</mass><inertia><ixx>1e-4</ixx><iyy>1e-4</iyy><izz>1e-4</izz></inertia></inertial>
</link>
<joint name="elbow" type="revolute">
  <parent>base</parent><child>arm</child>
  <axis><xyz>0 0 1</xyz>{{0}}</axis>
</joint>
{{1}}
"""
_CONTROLLER = """
<plugin filename="gz-sim-joint-position-controller-system" name="gz::sim::systems::JointPositionController">
  <joint_name>elbow</joint_name>
  <p_gain>1</p_gain><d_gain>0.5</d_gain>
</plugin>
"""
_STACK = f"""
<model name="pebble"><pose>0 0 0.05 0 0 0</pose><link name="body">
  <inertial><mass>0.1</mass><inertia><ixx>1e-3</ixx><iyy>1e-3</iyy><izz>1e-3</izz></inertia></inertial>
  {_BOX.format(0.1)}
</link></model>
<model name="rock"><pose>0 0 0.5995 0 0 0</pose><link name="body">
  <inertial><mass>2000</mass><inertia><ixx>333</ixx><iyy>333</iyy><izz>333</izz></inertia></inertial>
  {_BOX.format(1)}
</link></model>
"""

CODES: tuple[Code, ...] = (
    Code(
        "SK-LINT-001",
        "warning",
        "a step of more than 5 ms with links that move and collide",
        "`<max_step_size>0.001</max_step_size>`",
        world(_FALLING),
    ),
    Code(
        "SK-LINT-002",
        "note",
        "a sensor's rate that is no whole number of steps; the pattern of its stamps is given",
        "the mean rate is kept all the same",
        sensor("imu", "<update_rate>30</update_rate>"),
    ),
    Code(
        "SK-LINT-003",
        "warning",
        "a controller's gain that rings at this step on the inertia that its joint feels; the largest good is given",
        "a smaller gain or a smaller step",
        model(_ARM.format("", _CONTROLLER)),
    ),
    Code(
        "SK-LINT-004",
        "warning",
        "a joint's spring that swings faster than the step can follow",
        "a softer spring or a smaller step",
        model(_ARM.format("<dynamics><spring_stiffness>1000</spring_stiffness></dynamics>", "")),
    ),
    Code(
        "SK-LINT-005",
        "note",
        "a joint whose limits leave it no room",
        "a joint of type `fixed` says the same and costs nothing",
        model(_ARM.format("<limit><lower>0</lower><upper>0</upper></limit>", "")),
    ),
    Code(
        "SK-LINT-006",
        "warning",
        "a body stands on one of less than a ten-thousandth of its mass and sinks in by more than 1 mm",
        "give the lower one more mass",
        world(_STACK),
    ),
    Code(
        "SK-LINT-007",
        "warning",
        "a part of a model's mass comes from links without `<inertial>`, to which SDF gives 1 kg each",
        "give them an inertia, or make them a `<frame>`",
        model(
            f'<link name="base">{INERTIAL}</link>\n<link name="camera_frame"/>\n'
            '<joint name="mount" type="fixed"><parent>base</parent><child>camera_frame</child></joint>'
        ),
    ),
    Code(
        "SK-LINT-008",
        "warning",
        "an inertia larger than the size of the link allows, as from wrong units",
        "a part in mm and g gives an inertia in g·mm², 1e-9 kg·m²",
        link(_BOX.format(0.01)),
    ),
    Code(
        "SK-LINT-009",
        "warning",
        "a mass that no material has in the size of the link's collisions: above 25 000 or below 0.1 kg/m³",
        "check the units of the mass and of the collision's size",
        link(_BOX.format(10)),
    ),
    Code(
        "SK-LINT-010",
        "warning",
        "a collision five times larger than what is drawn",
        "check the scale of the collision's mesh",
        link(f"{_BOX.format(1)}\n{_LOOK.format(0.1)}"),
    ),
)
