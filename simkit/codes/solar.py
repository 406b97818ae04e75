"""Solar sensors and the sun."""

from __future__ import annotations

from simkit.codes import Code, Example
from simkit.codes.sketch import model, world


def _station(solar: str, lights: str) -> Example:
    """A world with lights and a solar sensor."""
    return world(
        f'{lights}\n<model name="station">\n  <static>true</static>\n  <link name="head">\n'
        f'    <sensor name="eye" type="custom" gz:type="solar">\n      <solar>{solar}</solar>\n    </sensor>\n'
        "  </link>\n</model>"
    )


_SUN = '<light name="sun" type="directional"/>'
_LAMP = '<light name="lamp" type="point"><pose>0 0 9 0 0 0</pose></light>'

CODES: tuple[Code, ...] = (
    Code(
        "SK-SENSOR-080",
        "error",
        "a solar sensor's `<light_name>` names no light of the world",
        "those there are listed",
        _station("<light_name>son</light_name>", _SUN),
    ),
    Code(
        "SK-SENSOR-081",
        "note",
        "a solar sensor on a bare model, which has no light: its readings are invalid until it stands in a world",
        "",
        model('<link name="head">\n  <sensor name="eye" type="custom" gz:type="solar"><solar/></sensor>\n</link>'),
    ),
    Code(
        "SK-SENSOR-082",
        "warning",
        "a solar sensor without `<light_name>` in a world that has no directional light; every reading is invalid",
        "`model://sun`, or name another light",
        _station("", _LAMP),
    ),
    Code(
        "SK-SENSOR-083",
        "warning",
        "an option of a solar sensor that has no effect on a light of its type",
        "",
        _station("<light_name>sun</light_name><falloff>inverse_square</falloff>", _SUN),
    ),
    Code(
        "SK-SENSOR-084",
        "error",
        "`simkit::Sun` needs pvlib, which is not installed",
        "pip install 'simkit-robotics[sun]'",
        without="it takes an installation without pvlib",
    ),
    Code(
        "SK-SENSOR-085",
        "warning",
        "`simkit::Sun` in a world that is not on the Earth; its sun is the Earth's",
        "",
        world(
            f"{_SUN}\n<spherical_coordinates><surface_model>MOON_SCS</surface_model>"
            "<latitude_deg>10</latitude_deg></spherical_coordinates>\n"
            '<plugin name="simkit::Sun" filename="simkit-sun"><start>2024-06-21T10:30:00Z</start></plugin>'
        ),
    ),
)
