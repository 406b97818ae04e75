"""Contact sensors, and the plugins that read contacts."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import INERTIAL, link, model

_HULL = '<collision name="hull"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision>'
_TOUCH = """
<plugin filename="gz-sim-touchplugin-system" name="gz::sim::systems::TouchPlugin">
  <target>{target}</target><time>1</time><namespace>probe</namespace><enabled>true</enabled>
</plugin>
"""


def _sensor(content: str, plugin: str = "") -> str:
    return f'<sensor name="skin" type="contact">\n  <contact>{content}</contact>{plugin}\n</sensor>'


def _robot(target: str, sensor: str) -> str:
    return f'<link name="base">{INERTIAL}\n{_HULL}\n{sensor}</link>{_TOUCH.format(target=target)}'


_WATCHES = _sensor("<collision>hull</collision>")

CODES: tuple[Code, ...] = (
    Code(
        "SK-SENSOR-040",
        "warning",
        "a contact sensor names a collision that its link does not have; nothing of it is felt",
        "those of the link are listed; names that Gazebo gives a URDF robot's collisions are understood",
        link(f"{_HULL}\n{_sensor('<collision>hul</collision>')}"),
    ),
    Code(
        "SK-SENSOR-041",
        "warning",
        "a contact sensor names no collision; it feels nothing, as in Gazebo",
        "name each in `<contact>`",
        link(f"{_HULL}\n{_sensor('')}"),
    ),
    Code(
        "SK-SENSOR-042",
        "warning",
        "a bumper's frame is no link; its contacts are told in the world frame until there is one",
        "the closest name is given",
        link(
            _HULL
            + _sensor(
                "<collision>hull</collision>",
                '\n<plugin name="bumper" filename="libgazebo_ros_bumper.so"><frame_name>bass</frame_name></plugin>',
            )
        ),
    ),
    Code(
        "SK-SENSOR-043",
        "warning",
        "a TouchPlugin on a model without a contact sensor; it never touches",
        "a contact sensor on one of the model's links, or `<collision>` and `<create_contact_sensor_for_collision>`",
        model(_robot("hull", "")),
    ),
    Code(
        "SK-SENSOR-044",
        "warning",
        "no collision has the `<target>` of a TouchPlugin in its name; one is waited for",
        "the closest name is given",
        model(_robot("wall", _WATCHES)),
    ),
)
