"""Altimeter, magnetometer, satellite receiver, air pressure, air speed."""

from __future__ import annotations

from simkit.codes import Code, Example
from simkit.codes.sketch import sensor, world

_GPS_PLUGIN = '<plugin name="gps" filename="libgazebo_ros_gps_sensor.so"/>'
_PLACE = "<spherical_coordinates>{}<latitude_deg>47.4</latitude_deg></spherical_coordinates>"


def _instrument(kind: str, block: str = "", place: str = "", pose: str = "0 0 0 0 0 0") -> Example:
    """A world with a static model that carries one sensor."""
    return world(f"""
{place}
<model name="robot">
  <static>true</static><pose>{pose}</pose>
  <link name="base"><sensor name="eye" type="{kind}">{block}</sensor></link>
</model>
""")


CODES = (
    Code(
        "SK-SENSOR-060",
        "error",
        "the air of the world has no temperature above absolute zero",
        "`<temperature>` is in kelvin",
        _instrument("air_pressure", place="<atmosphere><temperature>0</temperature></atmosphere>"),
    ),
    Code(
        "SK-SENSOR-061",
        "warning",
        "a sensor of the air stands where the standard atmosphere has no table; it is extended",
        "the table reaches from -5 to 86 km; above it the air keeps its temperature, below it the lowest rate goes on",
        _instrument("air_pressure", pose="0 0 90000 0 0 0"),
    ),
    Code(
        "SK-SENSOR-062",
        "warning",
        "`<reference_altitude>` is not used in a world that asks for Gazebo's behaviour",
        "put the model at that height, or leave `<simkit:gazebo_quirks>` out",
        _instrument(
            "air_pressure",
            "<air_pressure><reference_altitude>500</reference_altitude></air_pressure>",
            "<gazebo_quirks>true</gazebo_quirks>",
        ),
    ),
    Code(
        "SK-SENSOR-063",
        "error",
        "the date of a magnetometer is none, or there is no model of the Earth's field for it",
        "a date as 2026-07-01 or 2026.5, from 2015 to 2030",
        sensor("magnetometer", "<magnetometer><date>1899-05-01</date></magnetometer>"),
    ),
    Code(
        "SK-SENSOR-064",
        "note",
        "the world is on a surface without a model of its magnetic field; `<magnetic_field>` is used",
        "",
        _instrument("magnetometer", place=_PLACE.format("<surface_model>MOON_SCS</surface_model>")),
    ),
    Code(
        "SK-SENSOR-065",
        "warning",
        "`<magnetic_field>` is not used: a world with `<spherical_coordinates>` has the Earth's field, as in Gazebo",
        "leave one of the two out",
        _instrument("magnetometer", place="<magnetic_field>1e-5 0 0</magnetic_field>" + _PLACE.format("")),
    ),
    Code(
        "SK-SENSOR-066",
        "warning",
        "the world is deeper or higher than the model of the Earth's field is made for",
        "1 km below to 850 km above the ellipsoid; beyond it the series is evaluated all the same",
        _instrument("magnetometer", place=_PLACE.format("<elevation>2e6</elevation>")),
    ),
    Code(
        "SK-SENSOR-067",
        "warning",
        "a satellite receiver gives nothing: the world does not say where on a planet it is",
        "give the world `<spherical_coordinates>`",
        sensor("navsat", "<update_rate>10</update_rate>"),
    ),
    Code(
        "SK-SENSOR-068",
        "warning",
        "a world for Gazebo Classic undoes Classic's half turn of the heading, which is not done here",
        "`<heading_deg>0</heading_deg>`, or `<simkit:gazebo_quirks>`",
        _instrument("gps", _GPS_PLUGIN, _PLACE.format("<heading_deg>180</heading_deg>")),
    ),
)
