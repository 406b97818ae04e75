"""Worlds with a quadrotor, an aeroplane and a VTOL, with numbers of the models x500 and advanced_plane of PX4."""

from __future__ import annotations

_MOTOR = 'filename="gz-sim-multicopter-motor-model-system" name="gz::sim::systems::MulticopterMotorModel"'
_SERVO = 'filename="gz-sim-joint-position-controller-system" name="gz::sim::systems::JointPositionController"'
_WING = 'filename="gz-sim-advanced-lift-drag-system" name="gz::sim::systems::AdvancedLiftDrag"'
ROTORS = ((0.174, -0.174, "ccw"), (-0.174, 0.174, "ccw"), (0.174, 0.174, "cw"), (-0.174, -0.174, "cw"))
THRUST = 8.54858e-06
"""Thrust of a rotor of the x500 divided by the square of its speed [N·s²/rad²]."""
PULL = 2.44858e-05
"""The same for the propeller of the aeroplane."""


def _rotor(number: int, pose: str, axis: str, way: str, constant: float) -> str:
    return f"""<link name="rotor_{number}"><pose>{pose}</pose><inertial><mass>0.016</mass>
      <inertia><ixx>3.8e-7</ixx><iyy>2.6e-5</iyy><izz>2.6e-5</izz></inertia></inertial></link>
    <joint name="rotor_{number}_joint" type="revolute"><parent>base_link</parent><child>rotor_{number}</child>
      <axis><xyz>{axis}</xyz><limit><lower>-1e16</lower><upper>1e16</upper></limit></axis></joint>
    <plugin {_MOTOR}><jointName>rotor_{number}_joint</jointName><linkName>rotor_{number}</linkName>
      <turningDirection>{way}</turningDirection><timeConstantUp>0.0125</timeConstantUp>
      <timeConstantDown>0.025</timeConstantDown><maxRotVelocity>1000.0</maxRotVelocity>
      <motorConstant>{constant}</motorConstant><momentConstant>0.016</momentConstant>
      <commandSubTopic>command/motor_speed</commandSubTopic><motorNumber>{number}</motorNumber>
      <rotorDragCoefficient>8.06428e-05</rotorDragCoefficient>
      <rollingMomentCoefficient>1e-06</rollingMomentCoefficient>
      <rotorVelocitySlowdownSim>10</rotorVelocitySlowdownSim><motorType>velocity</motorType></plugin>"""


def _base(mass: float, xx: float, yy: float, zz: float) -> str:
    return f"""<link name="base_link"><inertial><mass>{mass}</mass>
      <inertia><ixx>{xx}</ixx><iyy>{yy}</iyy><izz>{zz}</izz></inertia></inertial>
      <collision name="c"><geometry><box><size>0.35 0.35 0.05</size></box></geometry></collision>
      <sensor name="imu_sensor" type="imu"><always_on>1</always_on><update_rate>250</update_rate></sensor>
      <sensor name="air_pressure_sensor" type="air_pressure"><update_rate>50</update_rate></sensor>
      <sensor name="navsat_sensor" type="navsat"><update_rate>30</update_rate></sensor></link>"""


def _lifters() -> str:
    return "".join(_rotor(i, f"{x} {y} 0.06 0 0 0", "0 0 1", way, THRUST) for i, (x, y, way) in enumerate(ROTORS))


_SURFACES = (
    ("servo_0", "0 1 0", 1, (-0.000059, 0.000171, -0.01194, -0.003331, 0.001498, -0.000057)),
    ("servo_1", "0 1 0", 1, (-0.000059, -0.000171, -0.01194, 0.003331, 0.001498, 0.000057)),
    ("servo_2", "0 1 0", -1, (0.000274, 0, 0.010696, 0, -0.025798, 0)),
    ("servo_3", "0 0 1", 1, (0, -0.003913, 0, -0.000257, 0, 0.001613)),
)
_DERIVATIVES = {"CL0": 0.15188, "AR": 6.5, "eff": 0.97, "CLa": 5.015, "CD0": 0.029, "Cem0": 0.075, "Cema": -0.463966}
_DERIVATIVES |= {"CYb": -0.258244, "Cellb": -0.03925, "Cenb": 0.100826, "CYp": 0.065861, "Cellp": -0.487407}
_DERIVATIVES |= {"Cenp": -0.040416, "CDq": 0.055166, "CLq": 7.971792, "Cemq": -12.14014, "CYr": 0.230299}
_DERIVATIVES |= {"Cellr": 0.078165, "Cenr": -0.089947, "alpha_stall": 0.3391428111, "area": 0.34, "mac": 0.22}
_DERIVATIVES |= {"CLa_stall": -3.85, "CDa_stall": -0.9233984055, "Cema_stall": 0, "a0": 0, "air_density": 1.2041}


def _wing(cp: str = "-0.12 0 0") -> str:
    names = ("CD", "CY", "CL", "Cell", "Cem", "Cen")
    joints, surfaces = "", ""
    for number, (name, axis, direction, effects) in enumerate(_SURFACES):
        joints += f"""<link name="{name}_link"><inertial><mass>1e-8</mass>
            <inertia><ixx>1e-6</ixx><iyy>1e-6</iyy><izz>1e-6</izz></inertia></inertial></link>
          <joint name="{name}" type="revolute"><parent>base_link</parent><child>{name}_link</child>
            <axis><xyz>{axis}</xyz><limit><lower>-0.53</lower><upper>0.53</upper></limit>
            <dynamics><damping>1.0</damping></dynamics></axis></joint>
          <plugin {_SERVO}><joint_name>{name}</joint_name><sub_topic>{name}</sub_topic><p_gain>10</p_gain></plugin>"""
        values = "".join(f"<{c}_ctrl>{value}</{c}_ctrl>" for c, value in zip(names, effects, strict=True))
        surfaces += f"""<control_surface><name>{name}</name><index>{number}</index><direction>{direction}</direction>
          {values}</control_surface>"""
    derivatives = "".join(f"<{name}>{value}</{name}>" for name, value in _DERIVATIVES.items())
    return f"""{joints}<plugin {_WING}>{derivatives}<cp>{cp}</cp><forward>1 0 0</forward><upward>0 0 1</upward>
      <link_name>base_link</link_name><num_ctrl_surfaces>4</num_ctrl_surfaces>{surfaces}</plugin>"""


def _world(model: str, content: str, height: float) -> str:
    return f"""<sdf version="1.9"><world name="default">
      <physics type="ode"><max_step_size>0.004</max_step_size></physics>
      <gravity>0 0 -9.8</gravity><spherical_coordinates><latitude_deg>47.397971</latitude_deg>
      <longitude_deg>8.546163</longitude_deg><elevation>0</elevation></spherical_coordinates>
      <model name="ground_plane"><static>true</static><link name="link"><collision name="c">
      <geometry><plane/></geometry></collision></link></model>
      <model name="{model}"><pose>0 0 {height} 0 0 0</pose>{content}</model></world></sdf>"""


def x500(height: float = 0.24) -> str:
    """Return a world with a quadrotor of 2.064 kg."""
    return _world("x500", _base(2.0, 0.021667, 0.021667, 0.04) + _lifters(), height)


def advanced_plane(height: float = 100.0) -> str:
    """Return a world with an aeroplane of 1.016 kg, with ailerons, elevator and rudder."""
    puller = _rotor(0, "0.3 0 0 0 1.5707963 0", "1 0 0", "cw", PULL).replace("<xyz>", '<xyz expressed_in="base_link">')
    return _world("advanced_plane", _base(1.0, 0.197563, 0.1458929, 0.1477) + puller + _wing(), height)


def standard_vtol(height: float = 0.24) -> str:
    """Return a world with a quadrotor that has the wing of the aeroplane and a propeller at its nose."""
    pusher = _rotor(4, "0.3 0 0 0 1.5707963 0", "1 0 0", "cw", PULL).replace("<xyz>", '<xyz expressed_in="base_link">')
    content = _base(1.0, 0.197563, 0.1458929, 0.1477) + _lifters() + pusher + _wing("0 0 0")
    return _world("standard_vtol", content, height)
