"""Plugins of uuv_simulator: water, current, thrusters, fins and sensors of underwater vehicles."""

from __future__ import annotations

import math

import pytest

import simkit

G, RHO, MASS = 9.81, 1028.0, 100.0
CURRENT = """<plugin name="current" filename="libuuv_underwater_current_ros_plugin.so">
  <namespace>hydrodynamics</namespace><constant_current><topic>current_velocity</topic>
  <velocity><mean>{mean}</mean><min>0</min><max>5</max><mu>{mu}</mu><noiseAmp>{noise}</noiseAmp></velocity>
  <horizontal_angle><mean>{angle}</mean><min>-3.2</min><max>3.2</max></horizontal_angle></constant_current></plugin>"""
THRUSTER = """<plugin name="t" filename="libuuv_thruster_ros_plugin.so"><linkName>screw</linkName>
  <jointName>spin</jointName><thrusterID>3</thrusterID>{dynamics}{conversion}{more}</plugin>"""
FIRST = "<dynamics><type>FirstOrder</type><timeConstant>0.2</timeConstant></dynamics>"
BASIC = "<conversion><type>Basic</type><rotorConstant>0.01</rotorConstant></conversion>"


def vehicle(plugins: str = "", buoyancy: str = "<neutrally_buoyant>1</neutrally_buoyant>", depth: float = 10.0) -> str:
    added = " ".join("50" if i % 7 == 0 and i < 21 else "5" if i % 7 == 0 else "0" for i in range(36))
    return f"""<model name="rov"><pose>0 0 {-depth} 0 0 0</pose>
      <link name="rov/base_link"><inertial><mass>{MASS}</mass>
        <inertia><ixx>10</ixx><iyy>10</iyy><izz>10</izz></inertia></inertial>
        <collision name="c"><geometry><box><size>1 0.8 0.5</size></box></geometry></collision></link>
      <link name="screw"><pose>-0.5 0 0 0 0 0</pose><inertial><mass>0.001</mass>
        <inertia><ixx>1e-4</ixx><iyy>1e-4</iyy><izz>1e-4</izz></inertia></inertial></link>
      <joint name="spin" type="continuous"><parent>rov/base_link</parent><child>screw</child>
        <axis><xyz>1 0 0</xyz></axis></joint>
      <plugin name="water" filename="libuuv_underwater_object_ros_plugin.so"><fluid_density>{RHO}</fluid_density>
        <flow_velocity_topic>hydrodynamics/current_velocity</flow_velocity_topic>
        <link name="rov/base_link"><volume>0.15</volume>{buoyancy}<center_of_buoyancy>0 0 0.2</center_of_buoyancy>
        <hydrodynamic_model><type>fossen</type><added_mass>{added}</added_mass>
        <linear_damping>-20 -20 -20 -10 -10 -10</linear_damping>
        <quadratic_damping>-50 -50 -50 -10 -10 -10</quadratic_damping></hydrodynamic_model></link></plugin>
      {plugins}</model>"""


def world(content: str) -> str:
    return f"""<sdf version="1.6"><world name="sea"><gravity>0 0 {-G}</gravity>
      <physics name="p" type="ode"><max_step_size>0.01</max_step_size></physics>{content}</world></sdf>"""


@pytest.mark.slow
def test_a_vehicle_drifts_with_the_current_and_a_service_turns_it() -> None:
    current = CURRENT.format(mean=0.4, mu=0, noise=0, angle=0)
    with simkit.load(world(current + vehicle())) as sim:
        published = sim.subscribe("/hydrodynamics/current_velocity", keep=100)
        sim.run(30.0)
        assert len(published.messages) == 100
        assert published.messages[-1].twist.linear.x == 0.4
        assert sim.link("rov::rov/base_link").linear_velocity[0] == pytest.approx(0.4, rel=5e-2)
        answer = sim.call("/hydrodynamics/set_current_velocity", {"velocity": 0.3, "horizontal_angle": math.pi / 2})
        assert answer.success
        assert not sim.call("/hydrodynamics/set_current_velocity", {"velocity": 9.0}).success
        sim.run(40.0)
        x, y, _ = sim.link("rov::rov/base_link").linear_velocity
        assert (x, y) == pytest.approx((0.0, 0.3), abs=2e-2)
        assert sim.call("/hydrodynamics/get_current_horz_angle_model").mean == pytest.approx(math.pi / 2)


def test_a_noisy_current_stays_within_its_limits_and_follows_the_seed() -> None:
    def speeds(seed: int) -> list[float]:
        with simkit.load(world(CURRENT.format(mean=0.5, mu=0.1, noise=0.2, angle=0)), seed=seed) as sim:
            published = sim.subscribe("/hydrodynamics/current_velocity", keep=1000)
            sim.run(10.0)
            before = [m.twist.linear.x for m in published.messages]
            sim.reset()
            sim.run(10.0)
            assert [m.twist.linear.x for m in published.messages][len(before) :] == before
            return before

    first = speeds(1)
    assert first == speeds(1) != speeds(2)
    assert 0.0 <= min(first) < max(first) <= 5.0


def test_the_thrust_follows_the_command_with_the_rotor_and_pushes_the_vehicle() -> None:
    plugins = THRUSTER.format(dynamics=FIRST, conversion=BASIC, more="")
    with simkit.load(world(vehicle(plugins))) as sim:
        thrust = sim.subscribe("/rov/thrusters/3/thrust", keep=1)
        sim.publish("/rov/thrusters/3/input", {"data": 100.0})
        sim.run(0.2)
        assert sim.joint("rov::spin").velocity == pytest.approx(100.0 * (1 - math.exp(-1)), rel=0.06)
        sim.run(20.0)
        assert thrust.messages[-1].data == pytest.approx(100.0)
        speed = (-20 + math.sqrt(400 + 4 * 50 * 100)) / 100  # 20 v + 50 v² = 100 N
        assert sim.link("rov::rov/base_link").linear_velocity[0] == pytest.approx(speed, rel=2e-3)
        sim.call("/rov/thrusters/3/set_thrust_force_efficiency", {"efficiency": 0.5})
        sim.run(1.0)
        assert thrust.messages[-1].data == pytest.approx(50.0)
        sim.call("/rov/thrusters/3/set_thruster_state", {"on": False})
        sim.run(3.0)
        assert thrust.messages[-1].data == pytest.approx(0.0, abs=1e-3)


@pytest.mark.parametrize(
    ("conversion", "command", "expected"),
    [
        (
            "<type>Bessa</type><rotorConstantL>0.01</rotorConstantL><rotorConstantR>0.02</rotorConstantR>"
            "<deltaL>-100</deltaL><deltaR>50</deltaR>",
            20.0,
            0.02 * 350,
        ),
        (
            "<type>Bessa</type><rotorConstantL>0.01</rotorConstantL><rotorConstantR>0.02</rotorConstantR>"
            "<deltaL>-100</deltaL><deltaR>50</deltaR>",
            -9.0,
            0.0,
        ),
        (
            "<type>LinearInterp</type><inputValues>-1 0 1 3</inputValues><outputValues>-8 0 10 20</outputValues>",
            2.0,
            15.0,
        ),
        (
            "<type>LinearInterp</type><inputValues>-1 0 1 3</inputValues><outputValues>-8 0 10 20</outputValues>",
            -5.0,
            -8.0,
        ),
    ],
)
def test_each_thrust_curve_gives_the_thrust_of_its_formula(conversion: str, command: float, expected: float) -> None:
    zero = "<dynamics><type>ZeroOrder</type></dynamics>"
    plugins = THRUSTER.format(dynamics=zero, conversion=f"<conversion>{conversion}</conversion>", more="")
    with simkit.load(world(vehicle(plugins))) as sim:
        thrust = sim.subscribe("/rov/thrusters/3/thrust", keep=1)
        sim.publish("/rov/thrusters/3/input", {"data": command})
        sim.run(0.2)
        assert thrust.messages[-1].data == pytest.approx(expected)


def test_a_light_vehicle_rises_to_the_surface_and_is_no_longer_submerged() -> None:
    with simkit.load(world(vehicle(buoyancy="", depth=3.0))) as sim:
        submerged = sim.subscribe("/rov/is_submerged", keep=1)
        sim.run(0.1)
        assert submerged.messages[-1].data
        sim.run(30.0)
        height = float(sim.link("rov::rov/base_link").pose.position[2])
        assert -0.25 < height < 0.0
        assert not submerged.messages[-1].data


def test_services_scale_the_water_and_tell_its_properties() -> None:
    with simkit.load(world(vehicle())) as sim:
        listed = sim.call("/rov/get_model_properties").models[0]
        assert (listed.bbox_length, listed.bbox_width, listed.bbox_height) == pytest.approx((1.0, 0.8, 0.5))
        assert listed.volume == pytest.approx(MASS / RHO)
        assert sim.call("/rov/set_volume_offset", {"data": 0.02}).success
        assert not sim.call("/rov/set_damping_scaling", {"data": -1.0}).success
        sim.run(1.0)
        assert sim.link("rov::rov/base_link").linear_velocity[2] > 0.1
        assert sim.call("/rov/get_volume_offset").data == 0.02


FIN = """<link name="fin"><pose>-0.5 0 0 -1.5707963 0 0</pose><inertial><mass>0.1</mass>
    <inertia><ixx>1e-3</ixx><iyy>1e-3</iyy><izz>1e-3</izz></inertia></inertial></link>
  <joint name="hinge" type="revolute"><parent>rov/base_link</parent><child>fin</child>
    <axis><xyz>0 0 1</xyz><limit><lower>-0.5</lower><upper>0.5</upper></limit></axis></joint>
  <plugin name="f" filename="libuuv_fin_ros_plugin.so"><fin_id>1</fin_id><link_name>fin</link_name>
    <joint_name>hinge</joint_name><current_velocity_topic>hydrodynamics/current_velocity</current_velocity_topic>
    {dynamics}<liftdrag><type>Quadratic</type><lift_constant>100</lift_constant><drag_constant>10</drag_constant></liftdrag>
  </plugin>"""


def test_a_fin_turns_within_its_limits_and_the_flow_pushes_it() -> None:
    with simkit.load(world(vehicle(FIN.format(dynamics=FIRST)))) as sim:
        force = sim.subscribe("/rov/fins/1/wrench_topic", keep=1)
        sim.link("rov::rov/base_link").set_velocity((1.0, 0.0, 0.0))
        sim.publish("/rov/fins/1/input", {"data": 2.0})
        sim.run(1.0)
        assert sim.joint("rov::hinge").position == pytest.approx(0.5, abs=0.02)
        pushed = force.messages[-1].wrench.force
        fin = sim.link("rov::fin")
        x, y, _ = fin.linear_velocity @ fin.pose.matrix
        angle, square = math.atan2(y, x), x * x + y * y
        expected = math.hypot(100 * angle, 10 * angle * angle) * square
        assert math.hypot(pushed.x, pushed.y) == pytest.approx(expected, rel=0.1)  # published up to 0.05 s ago


def sensor(kind: str, more: str = "", rate: float = 10.0) -> str:
    return f"""<plugin name="{kind}" filename="libuuv_gazebo_ros_{kind}_plugin.so">
      <robot_namespace>rov</robot_namespace>
      <link_name>rov/base_link</link_name><sensor_topic>{kind}</sensor_topic><update_rate>{rate}</update_rate>
      <enable_local_ned_frame>{{ned}}</enable_local_ned_frame>{more}</plugin>""".format(ned=int("ned_odom" in more))


def test_the_sensors_measure_depth_velocity_and_position() -> None:
    beams = "".join(
        f"<beam_link_name_{i}>screw</beam_link_name_{i}><beam_topic_{i}>beam{i}</beam_topic_{i}>" for i in range(4)
    )
    plugins = sensor("subsea_pressure") + sensor("dvl", beams) + sensor("rpt") + sensor("imu")
    plugins += sensor("magnetometer") + sensor("pose_gt", "<publish_ned_odom>1</publish_ned_odom>")
    with simkit.load(world(vehicle(plugins))) as sim:
        kinds = ("subsea_pressure", "dvl", "dvl_twist", "rpt", "imu", "magnetometer", "pose_gt", "pose_gt_ned")
        got = {kind: sim.subscribe(f"/rov/{kind}", keep=50) for kind in kinds}
        sim.link("rov::rov/base_link").set_velocity((0.5, 0.0, 0.0))
        for index in range(4):
            sim.publish(f"/rov/beam{index}", {"range": 4.0 + index, "min_range": 0.5, "max_range": 80.0})
        sim.run(1.005)
        last = {kind: topic.messages[-1] for kind, topic in got.items()}
        assert {len(topic.messages) for topic in got.values()} == {10}
        speed = sim.link("rov::rov/base_link").linear_velocity[0]
        assert last["subsea_pressure"].fluid_pressure == pytest.approx(101.325 + 98.0638, rel=1e-3)
        assert last["dvl"].velocity.x == pytest.approx(speed, rel=2e-2)
        assert last["dvl"].altitude == 5.5
        assert [beam.range for beam in last["dvl"].beams] == [4.0, 5.0, 6.0, 7.0]
        assert last["dvl"].beams[0].pose.pose.position.x == pytest.approx(-0.5)
        assert last["rpt"].pos.pos.z == pytest.approx(-10.0, rel=1e-3)
        assert last["imu"].linear_acceleration.z == pytest.approx(G, rel=1e-2)
        assert last["magnetometer"].magnetic_field.z == pytest.approx(-math.sin(math.pi / 3), rel=1e-3)
        assert last["pose_gt"].pose.pose.position.z == pytest.approx(-10.0, rel=1e-3)
        sim.call("/rov/dvl/change_state", {"on": False})
        sim.run(1.0)
        assert len(got["dvl"].messages) == 10


def test_a_thruster_without_dynamics_is_reported_at_its_line() -> None:
    report = simkit.check(world(vehicle(THRUSTER.format(dynamics="", conversion=BASIC, more=""))))
    assert any(d.code == "SK-PARAM-001" and "<dynamics>" in d.message for d in report)


def test_a_receiver_publishes_its_position_on_the_topic_of_the_vehicle() -> None:
    place = """<spherical_coordinates><latitude_deg>56.7</latitude_deg><longitude_deg>5.9</longitude_deg>
      <elevation>0</elevation></spherical_coordinates>"""
    sensor = """<model name="buoy"><static>1</static><pose>0 1000 2 0 0 0</pose><link name="l">
      <sensor name="gps" type="gps"><update_rate>5</update_rate>
      <plugin name="g" filename="libuuv_gazebo_ros_gps_plugin.so">
      <robot_namespace>rexrov</robot_namespace><sensor_topic>gps</sensor_topic><update_rate>5</update_rate>
      <horizontal_pos_std_dev>2.0</horizontal_pos_std_dev></plugin></sensor></link></model>"""
    with simkit.load(world(place + sensor)) as sim:
        assert not [d for d in sim.diagnostics if d.severity != "note"]
        fixes = sim.subscribe("/rexrov/gps", keep=1)
        sim.run(1.0)
        fix = fixes.messages[-1]
        assert fix.header.frame_id == "rexrov/gps_link"
        assert fix.latitude == pytest.approx(56.7 + 1000 / 111_350, abs=1e-4)  # metres of a degree at this latitude
        assert fix.longitude == pytest.approx(5.9, abs=1e-6)


CHEMICAL = """<plugin name="c" filename="libuuv_gazebo_ros_cpc_plugin.so"><robot_namespace>rov</robot_namespace>
  <link_name>rov/base_link</link_name><plume_topic>/plume</plume_topic><sensor_topic>cpc</sensor_topic>
  <update_rate>10</update_rate><gamma>0.001</gamma><radius>3</radius><gain>{gain}</gain>
  <plume_salinity_value>{salinity}</plume_salinity_value><salinity_output_topic>salinity</salinity_output_topic>
  <enable_local_ned_frame>false</enable_local_ned_frame></plugin>"""


def test_a_chemical_sensor_measures_the_particles_near_it_and_the_salinity() -> None:
    with simkit.load(world(vehicle(CHEMICAL.format(gain=100, salinity=5)))) as sim:
        concentrations, salinities = sim.subscribe("/rov/cpc", keep=1), sim.subscribe("/rov/salinity", keep=1)
        sim.run(0.5)
        assert not concentrations.messages[-1].is_measuring
        assert salinities.messages[-1].salinity == 35.0
        depth = float(sim.link("rov::rov/base_link").pose.position[2])
        points = [{"x": 0.0, "y": 0.0, "z": depth}, {"x": 4.5, "y": 0.0, "z": depth}, {"x": 50.0, "y": 0.0, "z": depth}]
        cloud = {"points": points, "channels": [{"name": "time", "values": [0.0, 0.0, 0.0]}]}
        sim.publish("/plume", cloud)  # stamp 0: all particles are new
        sim.run(0.2)
        last = concentrations.messages[-1]
        expected = 100 * (4.0 + 0.5**3) / (4 * math.pi * 27.0)
        assert last.is_measuring
        assert last.concentration == pytest.approx(expected, rel=1e-3)
        assert last.position.z == pytest.approx(depth, abs=1e-3)
        assert salinities.messages[-1].salinity == pytest.approx(35 - 30 * min(expected, 1.0), rel=1e-3)
        sim.run(6.0)
        assert concentrations.messages[-1].concentration == 0.0


def test_a_plume_that_is_saltier_than_the_water_is_an_error() -> None:
    with pytest.raises(simkit.LoadError, match="SK-PARAM-002"):
        simkit.load(world(vehicle(CHEMICAL.format(gain=1, salinity=50))))


@pytest.mark.parametrize("library", ["libuuv_sc_ros_interface_plugin.so", "libdave_sc_coordinates_interface.so"])
def test_services_convert_positions_to_places_on_the_earth_and_back(library: str) -> None:
    world = f'''<sdf version="1.6"><world name="sea"><spherical_coordinates><latitude_deg>56</latitude_deg>
      <longitude_deg>10</longitude_deg></spherical_coordinates><plugin name="s" filename="{library}"/></world></sdf>'''
    with simkit.load(world) as sim:
        assert sim.call("/gazebo/get_origin_spherical_coordinates").latitude_deg == pytest.approx(56.0)
        place = sim.call("/gazebo/transform_to_spherical_coordinates", {"input": {"x": 100.0, "y": 200.0, "z": -10.0}})
        degrees = {"latitude_deg": place.latitude_deg, "longitude_deg": place.longitude_deg}
        back = sim.call("/gazebo/transform_from_spherical_coordinates", {**degrees, "altitude": place.altitude}).output
        assert (back.x, back.y, back.z) == pytest.approx((100.0, 200.0, -10.0), abs=1e-6)
