"""GPS receiver of Gazebo Classic."""

from __future__ import annotations

import pytest

import simkit


def classic(plugin: str, kind: str = "gps") -> str:
    return f"""<sdf version="1.6"><world name="w"><gravity>0 0 0</gravity><spherical_coordinates>
      <surface_model>EARTH_WGS84</surface_model><latitude_deg>-22.9</latitude_deg><longitude_deg>-43.2</longitude_deg>
      <elevation>12</elevation><heading_deg>90</heading_deg></spherical_coordinates>
      <model name="m"><link name="mast"><sensor name="s" type="{kind}"><always_on>true</always_on>
        <update_rate>30</update_rate>
        <plugin name="my_gps" filename="libgazebo_ros_gps_sensor.so">{plugin}</plugin></sensor></link></model>
      </world></sdf>"""


def test_fix_and_velocity_are_published_under_the_plugins_name() -> None:
    with simkit.load(classic("")) as sim:
        fix, velocity = sim.subscribe("/my_gps/out"), sim.subscribe("/my_gps/vel")
        sim.model("m").set_velocity((2.0, 0.0, 0.0), (0, 0, 0))
        sim.step(1)
        assert sim.topics()["/my_gps/out"] == "sensor_msgs/msg/NavSatFix"
        assert sim.topics()["/my_gps/vel"] == "geometry_msgs/msg/Vector3Stamped"
        assert not [t for t in sim.topics() if t.startswith("/world/") and t not in sim.communication.bus.aside]
        assert fix.latest.latitude == pytest.approx(-22.9, abs=1e-7)
        assert fix.latest.header.frame_id == velocity.latest.header.frame_id == "mast"
        assert velocity.latest.vector.y == pytest.approx(2.0)  # the world's x points north


def test_remappings_and_frame_name_apply() -> None:
    plugin = """<ros><namespace>/demo</namespace><remapping>~/out:=gps/fix</remapping>
      <remapping>~/vel:=gps/vel</remapping></ros><frame_name>antenna</frame_name>"""
    with simkit.load(classic(plugin)) as sim:
        sim.step(1)
        assert sim.sensor("m::mast::s").topic == "/demo/gps/fix"
        assert "/demo/gps/vel" in sim.topics()
        assert sim.sensor("m::mast::s").latest.header.frame_id == "antenna"


def test_on_another_sensor_it_is_an_error() -> None:
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(classic("", "altimeter"))
    assert "SK-PLUGIN-003" in [d.code for d in caught.value.diagnostics]


@pytest.mark.parametrize("quirks", [False, True])
def test_the_half_turn_of_classic_needs_gazebo_quirks(quirks: bool) -> None:
    """A world with a heading of 180 degrees gets a warning, and is correct with the quirks."""
    text = classic("").replace("<heading_deg>90<", "<heading_deg>180<")
    if quirks:
        text = text.replace("<gravity>", "<gazebo_quirks>true</gazebo_quirks><gravity>")
    with simkit.load(text) as sim:
        velocity = sim.subscribe("/my_gps/vel")
        sim.model("m").set_pose(simkit.Pose((100.0, 200.0, 0.0)))
        sim.model("m").set_velocity((1.0, 2.0, 0.0), (0, 0, 0))
        sim.step(40)
        fix = sim.sensor("m::mast::s").latest
        sign = 1 if quirks else -1
        assert (fix.latitude + 22.9) * sign == pytest.approx(200 / 110_700, rel=0.01)
        assert (fix.longitude + 43.2) * sign == pytest.approx(100 / 102_600, rel=0.01)
        assert velocity.latest.vector.x == pytest.approx(sign * 1.0, abs=1e-3)
        assert ("SK-SENSOR-068" in [d.code for d in sim.diagnostics]) != quirks
