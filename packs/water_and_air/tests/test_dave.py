"""Plugins of dave: its Doppler velocity log, and currents that depend on depth and tide."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

import simkit

LAYERS = "information,,\nmore,,\nnorth,east,depth\n0.2,0.0,0\n0.4,0.1,10\n0.6,0.0,20\n"
TIDE = """Date_Time (GMT), Event, Speed (cm/sec)
2021-03-04 00:00, flood,50
2021-03-04 03:00, slack,-
2021-03-04 04:00, flood,60
2021-03-04 06:00, ebb,-50
"""
DVL = """<sensor name="log" type="dsros_dvl"><update_rate>10</update_rate>{place}
  <plugin name="log" filename="libdsros_ros_dvl.so"><robotNamespace>rov</robotNamespace><topicName>dvl</topicName>
  <rangesTopicName>ranges</rangesTopicName><frameName>dvl_link</frameName><pointcloudFrame>hull</pointcloudFrame>
  <updateRateHZ>5</updateRateHZ><gaussianNoiseBeamVel>{noise}</gaussianNoiseBeamVel>
  <minRange>0.5</minRange><maxRange>{reach}</maxRange><maxRangeDiff>10</maxRangeDiff><beamAngleDeg>30</beamAngleDeg>
  <beamWidthDeg>4</beamWidthDeg><beamAzimuthDeg1>-135</beamAzimuthDeg1><beamAzimuthDeg2>135</beamAzimuthDeg2>
  <beamAzimuthDeg3>45</beamAzimuthDeg3><beamAzimuthDeg4>-45</beamAzimuthDeg4><enableWaterTrack>1</enableWaterTrack>
  <waterTrackBins>4</waterTrackBins><currentProfileCoordMode>{axes}</currentProfileCoordMode>
  <pos_z_down>{down}</pos_z_down></plugin></sensor>"""
CURRENT = """<plugin name="current" filename="libdave_ocean_current_plugin.so"><namespace>hydrodynamics</namespace>
  <constant_current><velocity><mean>0.3</mean><min>0</min><max>5</max></velocity></constant_current>
  <transient_current><databasefilePath>layers.csv</databasefilePath></transient_current>{tide}</plugin>"""
OSCILLATION = """<tidal_oscillation>{source}<mean_direction><ebb>0</ebb><flood>180</flood></mean_direction>
  <world_start_time_GMT><day>4</day><month>3</month><year>2021</year><hour>{hour}</hour></world_start_time_GMT>
  </tidal_oscillation>"""
AT_VEHICLE = """<plugin name="c" filename="libdave_ocean_current_model_plugin.so">
  <transient_current><velocity_north><noiseAmp>0.3</noiseAmp><noiseFreq>{noise}</noiseFreq></velocity_north>
  </transient_current><tide_oscillation>true</tide_oscillation></plugin>"""


def sea(depth: float, content: str = "", plugin: str = "", more: str = "") -> str:
    return f"""<sdf version="1.6"><world name="sea"><gravity>0 0 0</gravity>
      <physics name="p" type="ode"><max_step_size>0.01</max_step_size></physics>
      <model name="bottom"><static>1</static><pose>0 0 -30 0 0 0</pose><link name="l"><collision name="c"><geometry>
      <plane><normal>0 0 1</normal><size>200 200</size></plane></geometry></collision></link></model>{more}
      <model name="rov"><pose>0 0 {-depth} 0 0 0</pose><link name="hull"><inertial><mass>10</mass>
      <inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>{content}</link>{plugin}</model></world></sdf>"""


def write(folder: Path, text: str) -> Path:
    (folder / "layers.csv").write_text(LAYERS)
    (folder / "tide.csv").write_text(TIDE)
    file = folder / "sea.world"
    file.write_text(text)
    return file


@pytest.mark.parametrize(
    ("place", "down", "expected"),
    [("", 0, (0.5, 0.2, -0.1)), ("<pose>0 0 0 3.14159265358979 0 0</pose>", 1, (0.5, -0.2, 0.1))],
)
def test_a_log_measures_its_velocity_over_the_bottom(
    place: str, down: int, expected: tuple[float, float, float]
) -> None:
    text = sea(10, DVL.format(place=place, noise=0, reach=60, axes=0, down=down))
    with simkit.load(text) as sim:
        assert not [d for d in sim.diagnostics if d.severity != "note"]
        log, ranges = sim.subscribe("/rov/dvl", keep=10), sim.subscribe("/rov/ranges", keep=1)
        cloud = sim.subscribe("/rov/dvl_cloud", keep=1)
        sim.link("rov::hull").set_velocity((0.5, 0.2, -0.1))
        sim.run(1.0)
        last = log.messages[-1]
        assert len(log.messages) == 6  # from 0 s on, at <updateRateHZ>
        assert (last.velocity.x, last.velocity.y, last.velocity.z) == pytest.approx(expected, abs=1e-9)
        assert (last.velocity_mode, last.num_good_beams, last.header.frame_id) == (1, 4, "dvl_link")
        height = 30.0 + float(sim.link("rov::hull").pose.position[2])
        assert list(last.range) == pytest.approx([height / math.cos(math.radians(30))] * 4)
        assert last.altitude == pytest.approx(height)
        assert last.speed_gnd == pytest.approx(math.hypot(0.5, 0.2))
        assert last.course_gnd == pytest.approx(math.degrees(math.atan2(expected[0], expected[1])) % 360)
        points = [r.range.point for r in ranges.messages[-1].ranges]
        assert [abs(p.z) for p in points] == pytest.approx([height] * 4)
        assert min(p.z for p in cloud.messages[-1].points) == pytest.approx(-60 * math.cos(math.radians(30)), rel=1e-6)


def test_a_log_without_a_bottom_measures_the_water_and_the_profile_of_its_current(tmp_path: Path) -> None:
    log_text = DVL.format(place="", noise=0.001, reach=8, axes=1, down=0)
    with simkit.load(write(tmp_path, sea(1.0, log_text, more=CURRENT.format(tide=""))), seed=2) as sim:
        log, profile = sim.subscribe("/rov/dvl", keep=1000), sim.subscribe("/rov/dvl_current", keep=1)
        sim.run(10.0)
        last = log.messages[-1]
        assert (last.velocity_mode, last.num_good_beams) == (2, 0)
        assert all(math.isnan(r) for r in last.range)
        assert last.velocity.x == pytest.approx(-0.3, abs=0.02)
        cells = profile.messages[-1].vel_bin_beams
        depths = [1.0 + (0.5 + 7.5 / 4 * (i + 0.5)) * math.cos(math.radians(30)) for i in range(4)]
        measured = [cell.velocity_bin_beam[0].x for cell in cells]
        assert measured == pytest.approx([0.2 + 0.02 * depth for depth in depths], abs=0.02)
        before = [m.velocity.x for m in log.messages]
        sim.reset()
        sim.run(10.0)
        assert [m.velocity.x for m in log.messages][len(before) :] == before


def test_a_profile_ends_at_the_bottom() -> None:
    with simkit.load(sea(25, DVL.format(place="", noise=0, reach=20, axes=0, down=0))) as sim:
        profile = sim.subscribe("/rov/dvl_current", keep=1)
        sim.link("rov::hull").set_velocity((1.0, 0.0, 0.0))
        sim.run(1.0)
        speeds = [cell.velocity_bin_beam[0].x for cell in profile.messages[-1].vel_bin_beams]
        x = -math.cos(math.radians(135)) * 0.5
        assert speeds[0] == pytest.approx(-(x**2), abs=1e-6)
        assert speeds[1:] == [0.0] * 3


def test_a_log_without_its_plugin_or_with_wrong_limits_is_an_error() -> None:
    with pytest.raises(simkit.LoadError, match="SK-PARAM-001"):
        simkit.load(sea(10, '<sensor name="log" type="dsros_dvl"/>'))
    with pytest.raises(simkit.LoadError, match="SK-PARAM-002"):
        simkit.load(sea(10, DVL.format(place="", noise=0, reach=0.2, axes=0, down=0)), strict=True)


def test_the_current_at_a_vehicle_follows_its_depth_and_services_change_a_layer(tmp_path: Path) -> None:
    text = sea(15, plugin=AT_VEHICLE.format(noise=0), more=CURRENT.format(tide=""))
    with simkit.load(write(tmp_path, text)) as sim:
        here = sim.subscribe("/hydrodynamics/current_velocity/rov", keep=100)
        layers = sim.subscribe("/hydrodynamics/stratified_current_velocity", keep=1)
        sim.run(1.0)
        assert len(here.messages) == 20
        linear = here.messages[-1].twist.linear
        assert (linear.x, linear.y) == pytest.approx((0.5, 0.05), abs=1e-6)
        assert [v.x for v in layers.messages[-1].velocities] == pytest.approx([0.2, 0.4, 0.6])
        request = {"layer": 1, "velocity": 1.0, "horizontal_angle": math.pi / 2, "vertical_angle": 0.0}
        assert sim.call("/hydrodynamics/set_stratified_current_velocity", request).success
        assert not sim.call("/hydrodynamics/set_stratified_current_velocity", {"layer": 3}).success
        assert sim.call("/hydrodynamics/set_stratified_current_horz_angle", {"layer": 2, "angle": 0.0}).success
        sim.run(0.2)
        linear = here.messages[-1].twist.linear
        assert (linear.x, linear.y) == pytest.approx((0.3, 0.5), abs=1e-6)


def test_noise_of_the_current_at_a_vehicle_stays_within_its_limits(tmp_path: Path) -> None:
    text = sea(25, plugin=AT_VEHICLE.format(noise=1.0), more=CURRENT.format(tide=""))
    with simkit.load(write(tmp_path, text), seed=5) as sim:
        here = sim.subscribe("/hydrodynamics/current_velocity/rov", keep=1000)
        sim.run(20.0)
        speeds = [m.twist.linear.x for m in here.messages[2:]]
        assert min(speeds) == pytest.approx(0.3) and max(speeds) == pytest.approx(0.9)
        assert sum(speeds) / len(speeds) == pytest.approx(0.6, abs=0.05)


@pytest.mark.parametrize(
    ("source", "hour", "speed"),
    [
        ("<databasefilePath>tide.csv</databasefilePath>", 3, 0.0),  # flood 0.5 m/s at 0 h, ebb 0.5 m/s at 6 h
        ("<databasefilePath>tide.csv</databasefilePath>", 0, 0.5),
        ("<databasefilePath>tide.csv</databasefilePath>", 5, 2 / 6),  # the ebb flows to the opposite side: 180° further
    ],
)
def test_the_tide_of_a_table_drives_the_current(tmp_path: Path, source: str, hour: int, speed: float) -> None:
    tide = OSCILLATION.format(source=source, hour=hour)
    text = sea(15, plugin=AT_VEHICLE.format(noise=0), more=CURRENT.format(tide=tide))
    with simkit.load(write(tmp_path, text)) as sim:
        here = sim.subscribe("/hydrodynamics/current_velocity/rov", keep=1)
        sim.run(1.0)
        assert here.messages[-1].twist.linear.x == pytest.approx(abs(speed) * 0.5, abs=1e-4)


def test_the_tide_of_harmonic_parts_has_their_period(tmp_path: Path) -> None:
    part = "<M2><amp>1.0</amp><phase>90</phase><speed>15</speed></M2>"  # one turn a day, with its maximum at 0 h
    source = f"<harmonic_constituents>{part}</harmonic_constituents>"

    def speed(hour: int) -> float:
        tide = OSCILLATION.format(source=source, hour=hour)
        text = sea(15, plugin=AT_VEHICLE.format(noise=0), more=CURRENT.format(tide=tide))
        with simkit.load(write(tmp_path, text)) as sim:
            here = sim.subscribe("/hydrodynamics/current_velocity/rov", keep=1)
            sim.run(0.5)
            return float(here.messages[-1].twist.linear.x)

    assert [speed(h) for h in (0, 4, 6)] == pytest.approx([0.5, 0.25, 0.0], abs=1e-3)


@pytest.mark.parametrize(
    ("file", "text", "problem"),
    [("layers.csv", "a\nb\nc\n1,2\n", "line 4"), ("tide.csv", "a\n2021, flood, 5\n", "line 2")],
)
def test_an_invalid_table_is_an_error_with_its_line(tmp_path: Path, file: str, text: str, problem: str) -> None:
    tide = OSCILLATION.format(source="<databasefilePath>tide.csv</databasefilePath>", hour=3)
    world = write(tmp_path, sea(15, more=CURRENT.format(tide=tide)))
    (tmp_path / file).write_text(text)
    with pytest.raises(simkit.LoadError, match=problem):
        simkit.load(world, strict=True)
    (tmp_path / file).unlink()
    with pytest.raises(simkit.LoadError, match="there is no file"):
        simkit.load(world, strict=True)
