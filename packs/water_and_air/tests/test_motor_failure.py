"""Failures of motors, motors with polynomials, and the water around PX4's underwater vehicles."""

from __future__ import annotations

import math

import px4_worlds
import pytest

import simkit

GZ = '<plugin filename="MotorFailurePlugin" name="gz::sim::systems::MotorFailureSystem"/>'
CLASSIC = '<plugin name="failure" filename="libgazebo_motor_failure_plugin.so"/>'


@pytest.mark.parametrize(
    ("plugin", "topic"),
    [
        (GZ, "/model/x500/motor_failure/motor_number"),
        (CLASSIC, "/motor_failure/motor_number"),
        (CLASSIC, "/gazebo/motor_failure_num"),
    ],
)
def test_a_failed_motor_stops_and_zero_repairs_it(plugin: str, topic: str) -> None:
    text = f"{plugin}</model>".join(px4_worlds.x500().rsplit("</model>", 1))
    with simkit.load(text) as sim:
        sim.publish("/x500/command/motor_speed", {"velocity": [300.0] * 4})
        sim.run(0.3)
        joints = [sim.joint(f"x500::rotor_{i}_joint") for i in range(4)]
        assert [abs(j.velocity) for j in joints] == pytest.approx([30.0] * 4, rel=1e-2)
        sim.publish(topic, {"data": 2})
        sim.run(0.05)
        assert [abs(j.velocity) for j in joints] == pytest.approx([30.0, 0.0, 30.0, 30.0], rel=2e-2, abs=0.1)
        sim.publish(topic, {"data": 0})
        sim.run(0.3)
        assert abs(joints[1].velocity) == pytest.approx(30.0, rel=2e-2)


MOTOR = """<plugin filename="libGenericMotorModelPlugin.so" name="gz::sim::systems::GenericMotorModel">
  <jointName>spin</jointName><linkName>screw</linkName><motorNumber>0</motorNumber>
  <turningDirection>ccw</turningDirection><motorType>force_polynomial</motorType>
  <controlMethod>duty_cycle</controlMethod><minCommand>0</minCommand><minDutyCycle>1100</minDutyCycle>
  <maxDutyCycle>1900</maxDutyCycle><bidirectionalMotor>1</bidirectionalMotor>
  <positiveThrustPolynomial>[0.0, 2.0, 10.0, 0.0]</positiveThrustPolynomial>
  <negativeThrustPolynomial>[0.0, 1.0, 5.0, 0.0]</negativeThrustPolynomial>{more}</plugin>"""


def boat(plugin: str) -> str:
    return f"""<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity><model name="boat">
      <link name="hull"><inertial><mass>9.9</mass></inertial></link>
      <link name="screw"><pose>0 0 0 0 1.5707963 0</pose><inertial><mass>0.1</mass>
        <inertia><ixx>1e-3</ixx><iyy>1e-3</iyy><izz>1e-3</izz></inertia></inertial></link>
      <joint name="spin" type="continuous"><parent>hull</parent><child>screw</child>
        <axis><xyz>0 0 1</xyz></axis></joint>
      {plugin}</model></world></sdf>"""


@pytest.mark.parametrize(("pulse", "thrust"), [(1900, 12.0), (1700, 3.5), (1500, 0.0), (1300, -1.75), (1100, -6.0)])
def test_a_duty_cycle_gives_the_thrust_of_the_polynomial(pulse: float, thrust: float) -> None:
    with simkit.load(boat(MOTOR.format(more=""))) as sim:
        assert not [d for d in sim.diagnostics if d.severity != "note"]
        sim.publish("/boat/command/motor_speed", {"velocity": [float(pulse)]})
        sim.run(1.0)
        assert sim.link("boat::hull").linear_velocity[0] == pytest.approx(thrust / 10.0, rel=1e-2, abs=1e-9)


def test_a_motor_without_a_polynomial_is_reported() -> None:
    text = boat(MOTOR.format(more="").replace("positiveThrustPolynomial", "positivePolynomial"))
    assert any("positiveThrustPolynomial" in d.message for d in simkit.check(text))


@pytest.mark.slow
def test_the_water_of_px4_lifts_below_the_surface_and_brakes() -> None:
    plugin = """<plugin name="water" filename="libgazebo_uuv_plugin.so"><robotNamespace/>
      <baseLinkName>hull</baseLinkName><dampingLinear>5 5 20</dampingLinear><dampingAngular>1 1 1</dampingAngular>
      <buoyancy><link_name>hull</link_name><origin>0 0 0</origin><compensation>2</compensation>
      <height_scale_limit>0.1</height_scale_limit></buoyancy></plugin>"""
    text = f"""<sdf version="1.6"><world name="w"><gravity>0 0 -10</gravity><model name="rov"><pose>0 0 -1 0 0 0</pose>
      <link name="hull"><inertial><mass>10</mass></inertial></link>{plugin}</model></world></sdf>"""
    with simkit.load(text) as sim:
        hull = sim.link("rov::hull")
        hull.set_velocity((1.0, 0.0, 0.0))
        sim.run(2.0)
        assert hull.linear_velocity[0] == pytest.approx(math.exp(-5 / 10 * 2.0), rel=1e-2)
        sim.run(20.0)
        assert hull.pose.position[2] == pytest.approx(0.0, abs=1e-3)  # half of twice the weight


ROTORS = """<plugin name="m" filename="librotors_gazebo_motor_model.so"><robotNamespace>hummingbird</robotNamespace>
  <jointName>spin</jointName><linkName>screw</linkName><turningDirection>ccw</turningDirection><motorNumber>1</motorNumber>
  <motorConstant>1e-5</motorConstant><momentConstant>0</momentConstant><rotorDragCoefficient>0</rotorDragCoefficient>
  <rollingMomentCoefficient>0</rollingMomentCoefficient><motorType>velocity</motorType></plugin>
  <plugin name="b" filename="librotors_gazebo_multirotor_base_plugin.so"><linkName>hull</linkName></plugin>"""


@pytest.mark.parametrize(
    ("topic", "field"),
    [("command/motor_speed", "angular_velocities"), ("gazebo/command/motor_speed", "velocity")],
)
def test_a_rotor_of_rotors_listens_to_both_of_its_topics(topic: str, field: str) -> None:
    kind = "mav_msgs/msg/Actuators" if field == "angular_velocities" else "actuator_msgs/msg/Actuators"
    with simkit.load(boat(ROTORS)) as sim:
        assert not [d for d in sim.diagnostics if d.severity != "note"]
        sim.publish(f"/hummingbird/{topic}", simkit.msgs.make(kind, **{field: [0.0, 300.0]}))
        sim.run(0.5)
        assert sim.joint("boat::spin").velocity == pytest.approx(30.0, rel=1e-2)
        assert sim.link("boat::hull").linear_velocity[0] > 0.01
