"""An elevator of three floors, 3 m and 2 m apart, as text."""

from __future__ import annotations

HEIGHTS = (0.0, 3.0, 5.0)
_MASS = "<inertial><mass>{}</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>"
LIDAR = """<sensor name="beam" type="lidar"><pose>0 -1 0.5 0 0 1.5707963267948966</pose><update_rate>20</update_rate>
  <topic>/model/{model}/door_0/lidar</topic><lidar><scan><horizontal><samples>1</samples><min_angle>0</min_angle>
  <max_angle>0</max_angle></horizontal></scan><range><min>0.05</min><max>2</max></range></lidar></sensor>"""


def _body(name: str, z: float, mass: float, more: str = "") -> str:
    return f'<link name="{name}"><pose>0 0 {z} 0 0 0</pose><gravity>0</gravity>{_MASS.format(mass)}{more}</link>'


def _slide(name: str, child: str, axis: str, upper: float) -> str:
    return f"""<joint name="{name}" type="prismatic"><parent>shaft</parent><child>{child}</child><axis><xyz>{axis}</xyz>
      <limit><lower>-0.1</lower><upper>{upper}</upper></limit></axis></joint>"""


def _controller(joint: str, fastest: float) -> str:
    return f"""<plugin filename="gz-sim-joint-position-controller-system"
      name="gz::sim::systems::JointPositionController"><joint_name>{joint}</joint_name>
      <use_velocity_commands>true</use_velocity_commands><cmd_max>{fastest}</cmd_max></plugin>"""


def shaft(plugins: str, name: str = "lift_1", pose: str = "0 0 0 0 0 0", lidar: bool = False) -> str:
    """A model: cabin on joint `lift`, doors on `door_0` to `door_2` (open at 0.8 m), links `floor_0` to `floor_2`."""
    beam = LIDAR.format(model=name) if lidar else ""
    parts = [_body("shaft", 0, 100, beam), _body("cabin", 0.2, 200), _slide("lift", "cabin", "0 0 1", 6)]
    for k, z in enumerate(HEIGHTS):
        parts += [
            _body(f"floor_{k}", z, 1),
            f'<joint name="mark_{k}" type="fixed"><parent>shaft</parent><child>floor_{k}</child></joint>',
            _body(f"leaf_{k}", z, 10),
            _slide(f"door_{k}", f"leaf_{k}", "0 1 0", 0.8),
            _controller(f"door_{k}", 0.5),
        ]
    parts += ['<joint name="base" type="fixed"><parent>world</parent><child>shaft</child></joint>']
    return f'<model name="{name}"><pose>{pose}</pose>{"".join(parts)}{_controller("lift", 1.0)}{plugins}</model>'


def bare(plugins: str, mass: float = 500.0) -> str:
    """The same without controllers, with one door and a cabin of weight, for the elevators of Gazebo Classic."""
    cabin = f'<link name="cabin"><pose>0 0 0.2 0 0 0</pose>{_MASS.format(mass)}</link>'
    leaf = '<link name="leaf">' + _MASS.format(1) + "</link>"
    base = '<joint name="base" type="fixed"><parent>world</parent><child>shaft</child></joint>'
    slides = _slide("lift", "cabin", "0 0 1", 20) + _slide("door", "leaf", "0 1 0", 1.2)
    return f'<model name="lift_1">{_body("shaft", 0, 100)}{cabin}{leaf}{slides}{base}{plugins}</model>'


def elevator(parameters: str = "") -> str:
    return f"""<plugin filename="gz-sim-elevator-system" name="gz::sim::systems::Elevator">{parameters}</plugin>"""
