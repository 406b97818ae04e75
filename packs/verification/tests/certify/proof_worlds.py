"""Small test worlds: one for every plugin of simkit, in which the plugin has an effect."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import control_robots
import planar_arm
import test_comms as comms
import test_fetch as fetch
import test_gain_commands as gain_commands
import test_pr2_plugin as pr2
import test_ros_1_control as ros_1
import test_turtlebot3_traffic as traffic
import test_uuv as uuv
from proof_lab import BOX, HEAVY, LIGHT, gz, lab, plugin, ros, sensed, tags
from rooms import rooms

import simkit

ROOT = Path(__file__).resolve().parents[4]
REAR = tags(left_joint="rl_joint", right_joint="rr_joint", wheel_separation=0.4)
STEERED = tags(left_steering_joint="fl_steering", right_steering_joint="fr_steering")
FOUR = tags(front_left_joint="fl_joint", front_right_joint="fr_joint")
SLIP = tags(slip_compliance_lateral=0.5, slip_compliance_longitudinal=1, wheel_normal_force=30, wheel_radius=0.1)
NOISE = tags(time_for_rise=0.5) + '<noise type="gaussian"><mean>0</mean><stddev>0.2</stddev></noise>'
WIND = (
    f"<horizontal><magnitude>{NOISE}</magnitude><direction>{NOISE}</direction></horizontal><vertical>{NOISE}</vertical>"
)
BATTERY = tags(
    battery_name="b", voltage=12, open_circuit_voltage_constant_coef=12, open_circuit_voltage_linear_coef=-3
) + tags(
    initial_charge=1, capacity=0.001, resistance=0.06, smooth_current_tau=0.1, power_load=50, start_draining="true"
)
WING = tags(link_name="base", cla=4, cda=0.3, cma=0.2, alpha_stall=0.3, cla_stall=-2, cda_stall=1.5, area=0.4, a0=0.05)
TRACKS = gz("track-controller", tags(link="rl"), "TrackController") + gz(
    "track-controller", tags(link="rr"), "TrackController"
)
CONTACT = '<sensor name="s" type="contact"><contact><collision>c</collision></contact>{}</sensor>'
PAD = (
    f'<model name="pad"><pose>-1.2 1 0.16 0 0 0</pose><link name="l">{HEAVY}<collision name="c">'
    f"{BOX.format('.3 .3 .3')}</collision>{CONTACT.format('')}</link>"
)
RED = tags(width=32, height=24)
EYE = f"<camera><horizontal_fov>1.2</horizontal_fov><image>{RED}</image></camera>"
REALSENSE = "".join(
    f'<sensor name="d435{name}" type="{kind}"><update_rate>50</update_rate>{EYE}</sensor>'
    for name, kind in (("color", "camera"), ("ired1", "camera"), ("depth", "depth"))
)
BALL = '<model name="load"><pose>0 -2 0.2 0 0 0</pose><link name="l">' + LIGHT + "</link></model>"
FINGER = "<virtualJoint><name>arm</name><scale_factor>0.5</scale_factor></virtualJoint>"
DOWN = "<pose>0.3 0 -0.05 0 1.57 0</pose><update_rate>50</update_rate>"
KOBUKI = (
    f'{CONTACT.format("")}<sensor name="i" type="imu">{DOWN}</sensor><sensor name="r" type="ray">{DOWN}<ray><range>'
    "<min>0.01</min><max>0.15</max></range></ray></sensor>"
)
FIVE = "".join(tags(left_joint=n) for n in ("fl_joint", "rl_joint")) + "".join(
    tags(right_joint=n) for n in ("fr_joint", "rr_joint")
)
PUSHED = tags(wind_obj=tags(name="car", link_name="base", coeff_vector="0.5 0.5 0.3"))
SWELL = tags(wave=tags(model="CWR", number=2, amplitude=0.1, period=0.5, tau=0.1))
SPEED = tags(mean=1, min=0, max=5, mu=0.1, noiseAmp=0.2)
CURRENT = plugin(
    "libdave_ocean_current_plugin.so", tags(namespace="hydrodynamics", constant_current=tags(velocity=SPEED))
)
DSROS_LOG = plugin(
    "libdsros_ros_dvl.so",
    tags(frameName="log", pointcloudFrame="base", updateRateHZ=0, gaussianNoiseBeamVel=0.1, minRange=0.01, maxRange=20)
    + tags(beamAngleDeg=30, beamAzimuthDeg1=-135, beamAzimuthDeg2=135, beamAzimuthDeg3=45, beamAzimuthDeg4=-45)
    + tags(enableWaterTrack=1, waterTrackBins=3),
)
EKF = tags(odom0="/odom", odom0_config="1 1 0  0 0 1  1 1 0  0 0 1  0 0 0", base_link_frame="base", two_d_mode=1)
DENSITY = tags(uniform_fluid_density=40)
CREATE = plugin("libgazebo_ros_create_{}.so")
CREATE_DOCK = tags(receiver_link_name="base", dock_model_name="crate", emitter_link_name="l")
RMF_LIFT = tags(cabin_joint_name="lift") + '<floor name="L1" elevation="1"/><floor name="L2" elevation="2"/>'
MIMIC = tags(joint="door", mimicJoint="door_0", multiplier=0.5)
ROTORS = {
    "rotor_0": ("0.3 0.3 0.3", 1),
    "rotor_1": ("-0.3 0.3 0.3", -1),
    "rotor_2": ("-0.3 -0.3 0.3", 1),
    "rotor_3": ("0.3 -0.3 0.3", -1),
}
MOTORS = "".join(
    f'<link name="{name}"><pose>{place} 0 0 0</pose>{LIGHT}</link><joint name="{name}_joint" type="continuous">'
    f"<parent>base</parent><child>{name}</child><axis><xyz>0 0 1</xyz></axis></joint>"
    + gz(
        "multicopter-motor-model",
        tags(robotNamespace="car", jointName=f"{name}_joint", linkName=name, motorNumber=i, motorConstant=1e-3)
        + tags(turningDirection="ccw" if way > 0 else "cw", rotorDragCoefficient=0.01),
        "MulticopterMotorModel",
    )
    for i, (name, (place, way)) in enumerate(ROTORS.items())
)
ROTOR = "<rotor>{}</rotor>"
CONFIGURATION = "".join(
    ROTOR.format(tags(jointName=f"{name}_joint", forceConstant=1e-3, momentConstant=0.1, direction=way))
    for name, (_, way) in ROTORS.items()
)
FLIGHT = gz(
    "multicopter-control",
    tags(robotNamespace="car", comLinkName="base", velocityGain="1 1 1", attitudeGain="1 1 1", angularRateGain="1 1 1")
    + tags(rotorConfiguration=CONFIGURATION, linearVelocityNoiseStdDev="0.1 0.1 0.1"),
    "MulticopterVelocityControl",
)
VOXELS = tags(
    always_send_full_costmap="false",
    plugins="voxel_layer denoise_layer inflation_layer",
    voxel_layer=tags(
        plugin="nav2_costmap_2d::VoxelLayer", observation_sources="scan", scan=tags(observation_persistence=0.1)
    ),
    denoise_layer=tags(plugin="nav2_costmap_2d::DenoiseLayer", minimal_group_size=1),
)
NAVIGATION = (
    plugin("libsimkit_map_server.so", tags(height=0.5), "map_server")
    + plugin("libsimkit_fake_localization.so", tags(base_frame_id="base", update_rate=100), "fake_localization")
    + "".join(
        plugin(
            "libsimkit_costmap_2d.so",
            tags(robot_base_frame="base", update_frequency=100, publish_frequency=100, rolling_window=rolls) + layers,
            name,
        )
        for name, rolls, layers in (("global_costmap", "false", ""), ("local_costmap", "true", VOXELS))
    )
    + "".join(
        plugin(f"libsimkit_{name}.so", tags(robot_base_frame="base"), name)
        for name in ("planner_server", "smoother_server", "controller_server", "behavior_server")
    )
)
AIR = gz("wind-effects", tags(force_approximation_scaling_factor=0.5), "WindEffects")
SAILING = plugin("asv_sim2-wind-system", tags(topic="/wind"), "gz::sim::systems::Wind")
ANEMOMETER = (
    '<sensor name="a" type="custom" gz:type="anemometer" xmlns:gz="http://gazebosim.org/schema"><update_rate>50'
    '</update_rate><gz:anemometer><noise type="gaussian"><stddev>0.5</stddev></noise></gz:anemometer></sensor>'
)
DUTY = tags(motorType="force_polynomial", controlMethod="duty_cycle", maxDutyCycle=40, bidirectionalMotor=1) + tags(
    positiveThrustPolynomial="[0, 2, 5]", negativeThrustPolynomial="[0, 1, 3]"
)
WATER = tags(baseLinkName="base", addedMassLinear="1 2 3", dampingLinear="5 5 20", dampingAngular="1 1 1") + tags(
    buoyancy=tags(link_name="base", origin="0 0 0.1", compensation=1.2, height_scale_limit=0.3)
)
AT = "<pose>0 0 {} 0 0 0</pose>"
GZ_MOTOR = "gz-sim-multicopter-motor-model-system"
CLASSIC_MOTORS = MOTORS.replace("gz::sim::systems::MulticopterMotorModel", "motor")
ROTORS_MOTORS = CLASSIC_MOTORS.replace(GZ_MOTOR, "librotors_gazebo_motor_model.so")
DRIFT = tags(motionSmallNoise=0.2, motionDriftNoise=0.1, motionDriftNoiseTime=0.01, pub_odom="true", odom_hz=50)
PANELS = tags(color_1="red", color_2="green", color_3="yellow", visuals=tags(visual="v"))
ODOMETRY = ros("diff_drive", REAR + tags(robot_base_frame="base", publish_odom_tf="true"))
NAVIGATOR = plugin("libsimkit_bt_navigator.so", tags(robot_base_frame="base"), "bt_navigator")
FOLLOWER = plugin(
    "libsimkit_waypoint_follower.so",
    tags(
        waypoint_task_executor_plugin="ask",
        ask=tags(plugin="nav2_waypoint_follower::InputAtWaypoint", input_topic="go_on"),
    ),
    "waypoint_follower",
)
# a zoom goes on for the whole part of the run, between the random commands, which end at 1
ZOOM = plugin(
    "libPublisherPlugin.so",
    '<message type="gz.msgs.Double" topic="/zoom" every="0.05">data: 3</message>',
    "vrx::PublisherPlugin",
)
SMOKE = f'<sensor name="s" type="depth_camera"><update_rate>50</update_rate>{EYE}</sensor>' + (
    '<particle_emitter name="smoke" type="box"><pose>0.5 0 0.3 0 0 0</pose>'
    + tags(rate=500, lifetime=0.05, min_velocity=1, max_velocity=3, scale_rate=0.5)
    + "</particle_emitter>"
)
PRIUS = (
    tags(chassis="base", front_left_wheel="fl_joint", front_right_wheel="fr_joint", back_left_wheel="rl_joint")
    + tags(back_right_wheel="rr_joint", front_left_wheel_steering="fl_steering", steering_wheel="arm", back_torque=5)
    + tags(front_right_wheel_steering="fr_steering", front_brake_torque=2, back_brake_torque=2)
    + tags(flwheel_steering_p_gain=20, flwheel_steering_i_gain=5, flwheel_steering_d_gain=1)
    + tags(frwheel_steering_p_gain=20, frwheel_steering_i_gain=5, frwheel_steering_d_gain=1)
)
SLOW = '<physics type="ode"><max_step_size>0.2</max_step_size></physics>'  # traffic changes after some seconds
CROSSING = (
    f'<sdf version="1.9"><world name="w">{SLOW}'
    f'<model name="bar"><link name="l">{LIGHT}</link>{plugin("libtraffic_bar_plugin.so")}</model></world></sdf>'
)
COUNTER = """
class Counter:
    def configure(self, entity, sdf, ecm, event_mgr):
        self.steps, self.seen = 0, [0.0]

    def pre_update(self, info, ecm):
        self.steps += 1
        self.seen.append(self.seen[-1] * 0.5 + self.steps)


def get_system():
    return Counter()
"""

DRIFT = uuv.CURRENT.format(mean=1, mu=0.1, noise=0.2, angle=0.5)
BEAMS = "".join(
    f"<beam_link_name_{i}>screw</beam_link_name_{i}><beam_topic_{i}>beam{i}</beam_topic_{i}>" for i in range(4)
)
RADIO = comms.RF.format(most=-1, sigma=6, capacity=8000)


def _swimming(plugins: str, *, depth: float = 10.0) -> str:
    """Return a world with a vehicle in a current."""
    return uuv.world(DRIFT + uuv.vehicle(plugins, buoyancy="", depth=depth))


def _underwater_sensor(kind: str, more: str = "") -> str:
    noise = tags(noise_sigma=0.1, noise_amplitude=1)
    return _swimming(uuv.sensor(kind, more + noise, rate=25))


def _talking(kind: str, name: str, more: str, distance: float) -> str:
    return comms.world(comms.system(kind, name, more), distance)


WORLDS: dict[str, str] = {
    # ------------------------------------------------------------------ drives
    "DiffDrive": lab(model=gz("diff-drive", REAR + tags(wheel_radius=0.1, max_linear_acceleration=1), "DiffDrive")),
    "GazeboRosDiffDrive": lab(
        model=ros(
            "diff_drive", REAR + tags(wheel_diameter=0.2, max_wheel_torque=5, publish_odom="true", odometry_source=0)
        )
    ),
    "GazeboRosKobuki": lab(
        model=ros(
            "kobuki",
            tags(left_wheel_joint_name="rl_joint", right_wheel_joint_name="rr_joint", wheel_separation=0.4, torque=5)
            + tags(wheel_diameter=0.2, velocity_command_timeout=0.05, publish_tf="true", bumper_name="s", imu_name="i")
            + tags(cliff_sensor_left_name="r", cliff_detection_threshold=0.05, dock_model="wall"),
        ),
        sensor=KOBUKI,
    ),
    "GazeboRosSkidSteerDrive": lab(
        model=ros(
            "skid_steer_drive",
            tags(leftFrontJoint="fl_joint", rightFrontJoint="fr_joint", leftRearJoint="rl_joint")
            + tags(rightRearJoint="rr_joint", torque=20, wheelSeparation=0.4, wheelDiameter=0.2, updateRate=50),
        )
    ),
    "GazeboRosAckermannDrive": lab(
        model=ros(
            "ackermann_drive",
            FOUR
            + STEERED
            + tags(rear_left_joint="rl_joint", rear_right_joint="rr_joint", publish_odom="true")
            + tags(left_steering_pid_gain="15 0 1", right_steering_pid_gain="15 0 1", linear_velocity_pid_gain="2 1 0"),
        )
    ),
    "AckermannSteering": lab(
        model=gz(
            "ackermann-steering",
            REAR + STEERED + tags(wheel_base=0.6, kingpin_width=0.4, wheel_radius=0.1),
            "AckermannSteering",
        )
    ),
    "GazeboRosTricycleDrive": lab(
        model=ros(
            "tricycle_drive",
            tags(steering_joint="fl_steering", actuated_wheel_joint="fl_joint", encoder_wheel_left_joint="rl_joint")
            + tags(encoder_wheel_right_joint="rr_joint", actuated_wheel_diameter=0.2, encoder_wheel_diameter=0.2)
            + tags(
                wheel_separation=0.4, max_wheel_torque=5, publish_odom="true", max_steering_speed=0.5, odometry_source=0
            ),
        )
    ),
    "MecanumDrive": lab(
        model=gz(
            "mecanum-drive",
            FOUR
            + tags(back_left_joint="rl_joint", back_right_joint="rr_joint", wheel_separation=0.4, wheelbase=0.6)
            + tags(wheel_radius=0.1, max_acceleration=1, min_acceleration=-1),
            "MecanumDrive",
        )
    ),
    "GazeboRosPlanarMove": lab(model=ros("planar_move", tags(cmdTimeout=0.05))),
    "VelocityControl": lab(model=gz("velocity-control", tags(initial_linear="0.3 0 0"), "VelocityControl")),
    "DriveToPoseController": lab(
        model=gz("diff-drive", REAR + tags(wheel_radius=0.1), "DiffDrive")
        + gz("odometry-publisher", "", "OdometryPublisher")
        + gz("drive-to-pose-controller", "", "DriveToPoseController")
    ),
    "TrackController": lab(model=TRACKS),
    "TrackedVehicle": lab(
        model=gz(
            "tracked-vehicle",
            "<left_track><link>rl</link></left_track><right_track><link>rr</link></right_track>"
            + tags(tracks_separation=0.4),
            "TrackedVehicle",
        )
        + TRACKS
    ),
    "SimpleTrackedVehiclePlugin": lab(
        model=plugin("libSimpleTrackedVehiclePlugin.so", tags(body="base", left_track="rl", right_track="rr"))
    ),
    "WheelTrackedVehiclePlugin": lab(
        model=plugin("libWheelTrackedVehiclePlugin.so", FIVE + tags(steering_efficiency=0.5))
    ),
    "WheelSlip": lab(
        model=gz("wheel-slip", f'<wheel link_name="rl">{SLIP}</wheel>', "WheelSlip")
        + gz("diff-drive", REAR + tags(wheel_radius=0.1), "DiffDrive")
    ),
    "ClassicWheelSlip": lab(
        model=plugin("libWheelSlipPlugin.so", f'<wheel link_name="rl">{SLIP}</wheel>')
        + gz("diff-drive", REAR + tags(wheel_radius=0.1), "DiffDrive")
    ),
    "GazeboRosWheelSlip": lab(
        model=ros("wheel_slip", f'<wheel link_name="rl">{SLIP}</wheel>')
        + gz("diff-drive", REAR + tags(wheel_radius=0.1), "DiffDrive")
    ),
    "TrajectoryFollower": lab(
        model=gz(
            "trajectory-follower",
            tags(link_name="base", force=9, torque=5, loop="true")
            + "<waypoints><waypoint>1 2</waypoint><waypoint>-1 0</waypoint></waypoints>",
            "TrajectoryFollower",
        )
    ),
    "FollowActor": lab(actor=gz("follow-actor", tags(target="crate", max_distance=20, velocity=2), "FollowActor")),
    # ------------------------------------------------------------------ joints
    "JointController": lab(
        model=gz(
            "joint-controller",
            tags(joint_name="arm", use_force_commands="true", p_gain=2, i_gain=5, d_gain=0.1),
            "JointController",
        )
    ),
    "JointPositionController": lab(
        model=gz(
            "joint-position-controller",
            tags(joint_name="arm", p_gain=50, i_gain=5, d_gain=2),
            "JointPositionController",
        )
    ),
    "JointTrajectoryController": lab(
        model=gz(
            "joint-trajectory-controller",
            tags(joint_name="arm", position_p_gain=50, position_i_gain=5, position_d_gain=2),
            "JointTrajectoryController",
        )
    ),
    "GazeboRosJointPoseTrajectory": lab(model=ros("joint_pose_trajectory", tags(update_rate=100))),
    "ApplyJointForce": lab(model=gz("apply-joint-force", tags(joint_name="arm"), "ApplyJointForce")),
    "UnderactuatedFinger": lab(
        model=plugin("libgazebo_underactuated_finger.so", tags(actuatedJoint="fl_joint") + FINGER)
        + gz("joint-controller", tags(joint_name="fl_joint"), "JointController")
    ),
    "Elevator": lab(
        model=gz("joint-position-controller", tags(joint_name="door_0", p_gain=50), "JointPositionController")
        + gz("joint-position-controller", tags(joint_name="lift", p_gain=50), "JointPositionController")
        + gz("elevator", "", "Elevator")
    ),
    "ElevatorPlugin": lab(
        model=plugin("libElevatorPlugin.so", tags(lift_joint="lift", door_joint="door", floor_height=1))
    ),
    "GazeboRosElevator": lab(
        model=ros("elevator", tags(lift_joint="lift", door_joint="door", floor_height=1, bottom_floor=0, top_floor=3))
    ),
    "JointStatePublisher": lab(model=gz("joint-state-publisher", "", "JointStatePublisher")),
    "GazeboRosJointStatePublisher": lab(model=ros("joint_state_publisher", tags(update_rate=50, joint_name="arm"))),
    "RobotStatePublisher": lab(
        model=plugin("libsimkit_robot_state_publisher.so", tags(publish_frequency=50), "simkit::RobotStatePublisher")
    ),
    # ------------------------------------------------------------------ forces, air and water
    "ApplyLinkWrench": lab(
        world=gz(
            "apply-link-wrench",
            f"<persistent>{tags(entity_name='crate', entity_type='model', force='0 0 6')}</persistent>",
            "ApplyLinkWrench",
        )
    ),
    "GazeboRosForce": lab(model=ros("force", tags(bodyName="base", topicName="shove"))),
    "GazeboRosHandOfGod": lab(model=ros("hand_of_god", tags(link_name="base", kl=200, ka=50))),
    "LiftDrag": lab(
        model=gz("lift-drag", WING, "LiftDrag")
        + gz("velocity-control", tags(initial_linear="3 0 1"), "VelocityControl")
    ),
    "LiftDragPlugin": lab(
        model=plugin("libLiftDragPlugin.so", WING)
        + gz("velocity-control", tags(initial_linear="3 0 1"), "VelocityControl")
    ),
    "HectorImu": lab(model=plugin("libhector_gazebo_ros_imu.so", tags(accelDrift=0.1, rateGaussianNoise=0.1))),
    "HectorGps": lab(model=plugin("libhector_gazebo_ros_gps.so", tags(drift="1 1 1", updateRate=100))),
    "HectorMagnetic": lab(model=plugin("libhector_gazebo_ros_magnetic.so", tags(drift="0.1 0.1 0.1"))),
    "HectorSonar": sensed(
        "ray", plugin("libhector_gazebo_ros_sonar.so", tags(gaussianNoise=0.01, updateRate=50, topicName="front"))
    ),
    "CreateBumper": lab(world=PAD.replace("</contact>", "</contact>" + CREATE.format("bumper")) + "</model>"),
    "CreateCliffSensor": sensed("ray", CREATE.format("cliff_sensor")),
    "CreateIrIntensity": sensed("ray", CREATE.format("ir_intensity_sensor")),
    "CreateImu": sensed("imu", CREATE.format("imu")),
    "CreateIrOpcode": lab(model=plugin("libgazebo_ros_create_ir_opcode.so", CREATE_DOCK + tags(sensor_0_fov=7))),
    "CreateDockingStatus": lab(
        model=plugin("libgazebo_ros_create_docking_status.so", CREATE_DOCK + tags(update_rate=50))
    ),
    "CreateWheelDrop": lab(model=plugin("libgazebo_ros_create_wheel_drop.so", tags(joint_name="door"))),
    "CreateOpticalMouse": lab(
        model=plugin("libgazebo_ros_create_optical_mouse.so", tags(link="base"))
        + gz("velocity-control", tags(initial_linear="1 0 0"), "VelocityControl")
    ),
    "IfraConveyorBelt": lab(model=plugin("libros2_conveyorbelt_plugin.so", tags(joint_name="door"))),
    "AriacConveyorBelt": lab(model=plugin("libROSConveyorBeltPlugin.so", tags(joint="door", power=50))),
    "ContactVacuumGripper": lab(model=plugin("libROSVacuumGripperPlugin.so", tags(suction_cup_link="base"))),
    "Slotcar": lab(model=plugin("libslotcar.so", tags(nominal_power=20))),
    "RmfDoor": lab(model=plugin("libdoor.so", '<door left_joint_name="door" right_joint_name="door_0"/>')),
    "RmfLift": lab(model=plugin("liblift.so", RMF_LIFT)),
    "RmfComponents": lab(model=plugin("libregister_component.so", f'<component name="Lift">{RMF_LIFT}</component>')),
    "GazeboLinkAttacher": lab(world=BALL + plugin("libgazebo_link_attacher.so")),
    "GazeboRosLinkAttacher": lab(world=BALL + plugin("libgazebo_ros_link_attacher.so")),
    "MimicJoint": lab(model=plugin("libroboticsgroup_gazebo_mimic_joint_plugin.so", MIMIC)),
    "GraspFix": lab(
        world=BALL,
        model=plugin("libgazebo_grasp_fix.so", tags(palm_link="base", gripper_link="leaf", update_rate=200)),
    ),
    "MulticopterMotorModel": lab(model=MOTORS),
    "MulticopterVelocityControl": lab(model=MOTORS + FLIGHT),
    "ArduPilotPlugin": lab(
        model=plugin("libArduPilotPlugin.so", tags(imuName="s", fdm_port_in=0), "ArduPilotPlugin"),
        sensor='<sensor name="s" type="imu"/>',
    ),
    "GazeboMavlinkInterface": lab(
        model=plugin("libgazebo_mavlink_interface.so", tags(mavlink_tcp_port=0, use_tcp=1, enable_lockstep=1))
    ),
    "GazeboMotorModel": lab(
        model=MOTORS.replace("gz-sim-multicopter-motor-model-system", "libgazebo_motor_model.so").replace(
            "gz::sim::systems::MulticopterMotorModel", "motor"
        )
    ),
    "MultirotorBase": lab(model=plugin("libgazebo_multirotor_base_plugin.so", tags(linkName="base"))),
    "Px4Imu": lab(model=plugin("libgazebo_imu_plugin.so", tags(linkName="base"))),
    "Px4Magnetometer": lab(model=plugin("libgazebo_magnetometer_plugin.so")),
    "Px4Barometer": lab(model=plugin("libgazebo_barometer_plugin.so")),
    "Px4Gps": lab(model=plugin("libgazebo_gps_plugin.so", tags(gpsNoise=1, update_rate=50))),
    "Px4GroundTruth": lab(model=plugin("libgazebo_groundtruth_plugin.so")),
    "Thruster": lab(model=gz("thruster", tags(joint_name="rl_joint", velocity_control="true"), "Thruster")),
    "Hydrodynamics": lab(
        model=gz("hydrodynamics", tags(link_name="base", xU=-5, xDotU=-3, default_current="1 0 0"), "Hydrodynamics")
    ),
    "AdvancedLiftDrag": lab(
        model=gz(
            "advanced-lift-drag",
            tags(link_name="base", AR=5, eff=0.9, CL0=2, CD0=1, CLa=3, Cema=-0.3, Cellb=0.2, area=0.5),
            "AdvancedLiftDrag",
        )
    ),
    "BuoyancyEngine": lab(
        model=gz("buoyancy-engine", tags(link_name="base", max_inflation_rate=0.01, max_volume=1), "BuoyancyEngine")
    ),
    "SpacecraftThrusterModel": lab(
        model=gz(
            "spacecraft-thruster-model",
            tags(link_name="base", actuator_number=0, max_thrust=50, topic="jets", duty_cycle_frequency=20),
            "SpacecraftThrusterModel",
        )
    ),
    "LighterThanAirDynamics": lab(
        model=gz(
            "lighter_than_air_dynamics",
            tags(link_name="base", moment_inviscid_coeff=-1, moment_viscous_coeff=1, force_inviscid_coeff=-1)
            + tags(force_viscous_coeff=1, eps_v=0.3, axial_drag_coeff=1),
            "LighterThanAirDynamics",
        )
    ),
    "Surface": lab(
        model=plugin(
            "libSurface.so",
            tags(link_name="base", fluid_level=0.3, fluid_density=30, points=tags(point="0.3 0 0"), wavefield=SWELL),
            "vrx::Surface",
        )
    ),
    "PolyhedraBuoyancyDrag": lab(
        model=plugin(
            "libPolyhedraBuoyancyDrag.so",
            tags(fluid_density=200, fluid_level=0.2, linear_drag=1, wavefield=SWELL)
            + tags(buoyancy=tags(link_name="base", geometry="<sphere><radius>0.2</radius></sphere>")),
            "vrx::PolyhedraBuoyancyDrag",
        )
    ),
    "SimpleHydrodynamics": lab(
        model=plugin("libSimpleHydrodynamics.so", tags(link_name="base"), "vrx::SimpleHydrodynamics")
        + gz("velocity-control", tags(initial_linear="1 0 0"), "VelocityControl")
    ),
    "FoilLiftDrag": lab(
        model=plugin(
            "libasv_sim2-foil-lift-drag-system.so", tags(link_name="base", cp="0 0 0"), "gz::sim::systems::FoilLiftDrag"
        )
        + gz("velocity-control", tags(initial_linear="1 0.3 0"), "VelocityControl")
    ),
    "SailLiftDrag": lab(
        model=plugin(
            "libasv_sim2-sail-lift-drag-system.so", tags(link_name="base", cp="0 0 1"), "gz::sim::systems::SailLiftDrag"
        )
    ),
    "OceanCurrent": lab(world=CURRENT),
    "VehicleCurrent": lab(world=CURRENT, model=plugin("libdave_ocean_current_model_plugin.so")),
    "DsrosRosDvl": sensed("dsros_dvl", DSROS_LOG, world=CURRENT),
    "UuvGps": sensed("gps", plugin("libuuv_gazebo_ros_gps_plugin.so", tags(robot_namespace="car", sensor_topic="gps"))),
    "UuvChemicalSensor": lab(
        model=plugin(
            "libuuv_gazebo_ros_cpc_plugin.so",
            tags(robot_namespace="car", link_name="base", plume_topic="/plume", sensor_topic="cpc", update_rate=50),
        )
    ),
    "AcousticPinger": lab(
        model=plugin(
            "libAcousticPingerPlugin.so",
            tags(position="5 0 0", update_rate=50)
            + '<range_noise><noise type="gaussian"><stddev>0.1</stddev></noise></range_noise>',
        )
    ),
    "BallShooter": lab(
        model=plugin("libBallShooterPlugin.so", tags(projectile=tags(model_name="load", link_name="l"))), world=BALL
    ),
    "FlipperControl": lab(model=plugin("libflipper_control_plugin.so", tags(joint_name="door"))),
    "LaserRotate": lab(
        model=plugin(
            "liblaser_rotate_plugin.so", tags(joint_name="door", initial_velocity=1, rotation_angular_limit=0.02)
        )
    ),
    "Px4Airspeed": lab(model=plugin("libgazebo_airspeed_plugin.so")),
    "Px4Wind": lab(
        world=plugin("libgazebo_wind_plugin.so", tags(publishRate=50, windVelocityMean=4, windVelocityVariance=1))
        + gz("wind-effects", tags(force_approximation_scaling_factor=0.5), "WindEffects")
    ),
    "UsvWind": lab(
        world=plugin(
            "libUSVWind.so",
            tags(wind_direction=30, wind_mean_velocity=5, var_wind_gain_constants=1, update_rate=50) + PUSHED,
            "vrx::USVWind",
        )
    ),
    "UsvWindPlugin": lab(
        world=plugin(
            "libusv_gazebo_wind_plugin.so",
            tags(wind_direction=30, wind_mean_velocity=5, var_wind_gain_constants=1, update_rate=50) + PUSHED,
        )
    ),
    "WavefieldModelPlugin": lab(model=plugin("libWavefieldModelPlugin.so", SWELL)),
    "UsvDynamicsPlugin": lab(
        model=plugin("libWavefieldModelPlugin.so", SWELL)
        + plugin("libusv_gazebo_dynamics_plugin.so", tags(bodyName="base", length_n=2, waterDensity=40, hullRadius=0.1))
    ),
    "UsvThrust": lab(
        model=plugin(
            "libusv_gazebo_thrust_plugin.so",
            tags(cmdTimeout=0.05)
            + tags(thruster=tags(linkName="base", propJointName="rl_joint", cmdTopic="thrust", angleTopic="angle")),
        )
    ),
    "BuoyancyInWaves": lab(
        model=plugin("libWavefieldModelPlugin.so", SWELL)
        + plugin(
            "libbuoyancy_gazebo_plugin.so",
            tags(fluid_density=500, fluid_drag=1)
            + tags(link=tags(name="base", center_of_volume="0 0 0.1", area=0.1, height=0.4)),
        )
    ),
    "PublisherPlugin": lab(
        world=plugin(
            "libPublisherPlugin.so",
            '<message type="gz.msgs.Double" topic="/level" every="0.01">data: 2</message>',
            "vrx::PublisherPlugin",
        )
    ),
    # ------------------------------------------------------------------ boats and drones
    "AsvWind": lab(world=SAILING + AIR, sensor=ANEMOMETER),
    "AsvAnemometerSystem": lab(
        world=SAILING + plugin("asv_sim2-anemometer-system", name="gz::sim::systems::Anemometer"), sensor=ANEMOMETER
    ),
    "SailPositionController": lab(
        model=plugin(
            "asv_sim2-sail-position-controller-system",
            tags(joint_name="arm", p_gain=20, i_gain=5, d_gain=0.1),
            "gz::sim::systems::SailPositionController",
        )
    ),
    "FoilDynamics": lab(
        model=plugin("libfoil_dynamics_plugin.so", tags(link_type="rudder", link_name="base", area=0.1, mult_lift=1.2))
        + plugin("libfoil_dynamics_plugin.so", tags(link_type="sail", link_name="leaf", fluidVelocity="global"), "sail")
    ),
    "GenericMotorModel": lab(
        model=MOTORS.replace(GZ_MOTOR, "libGenericMotorModelPlugin.so")
        .replace("MulticopterMotorModel", "GenericMotorModel")
        .replace("<motorConstant>", DUTY + "<motorConstant>")
    ),
    "MotorFailure": lab(model=MOTORS + plugin("MotorFailurePlugin", name="gz::sim::systems::MotorFailureSystem")),
    "ClassicMotorFailure": lab(
        model=CLASSIC_MOTORS.replace(GZ_MOTOR, "libgazebo_motor_model.so") + plugin("libgazebo_motor_failure_plugin.so")
    ),
    "RotorsMotorModel": lab(model=ROTORS_MOTORS),
    "RotorsInterface": lab(
        world=plugin("librotors_gazebo_ros_interface_plugin.so"),
        model=ROTORS_MOTORS,
    ),
    "RotorsBase": lab(
        model=ROTORS_MOTORS + plugin("librotors_gazebo_multirotor_base_plugin.so", tags(linkName="base"))
    ),
    "RotorsImu": lab(model=plugin("librotors_gazebo_imu_plugin.so", tags(linkName="base"))),
    "RotorsOdometry": lab(
        model=plugin(
            "librotors_gazebo_odometry_plugin.so",
            tags(linkName="rod", parentFrameId="base", measurementDivisor=3, measurementDelay=5)
            + tags(noiseNormalPosition="0.1 0.1 0.1", noiseUniformQuaternion="0.02 0.02 0.02"),
        )
    ),
    "RotorsPressure": lab(
        model=plugin("librotors_gazebo_pressure_plugin.so", tags(linkName="base", pressureVariance=4))
    ),
    "RotorsMagnetometer": lab(
        model=plugin(
            "librotors_gazebo_magnetometer_plugin.so",
            tags(linkName="base", noiseNormal="1e-7 1e-7 1e-7", noiseUniformInitialBias="1e-7 1e-7 1e-7"),
        )
    ),
    "RotorsGps": sensed(
        "gps", plugin("librotors_gazebo_gps_plugin.so", tags(robotNamespace="car", linkName="base", gpsTopic="fix"))
    ),
    "SjtuDrone": lab(
        model=plugin("libplugin_drone.so", tags(bodyName="base", rollpitchIntegralGain=1, yawTimeConstant=0.1) + DRIFT)
    ).replace("<max_step_size>0.002", "<max_step_size>0.01"),
    "Px4Underwater": lab(model=plugin("libgazebo_uuv_plugin.so", WATER)),
    "WaveHydrodynamics": lab(
        model=plugin(
            "gz-waves1-hydrodynamics-system",
            tags(enable="car::base", hydrodynamics=tags(cDampL1=10, cDampR1=1)),
            "gz::sim::systems::Hydrodynamics",
        )
    )
    .replace('<model name="ground"><static>true</static>', '<model name="ground"><static>true</static>' + AT.format(-1))
    .replace('<model name="car">' + AT.format(0.1), '<model name="car">' + AT.format(-0.12)),
    "WaveVisual": lab(visual=plugin("libWaveVisual.so", tags(wavefield=SWELL), "vrx::WaveVisual")),
    "LightBuoy": sensed("camera", visual=plugin("libLightBuoyPlugin.so", PANELS, "vrx::LightBuoyPlugin")).replace(
        "<max_step_size>0.002", "<max_step_size>0.02"
    ),
    "Buoyancy": lab(world=gz("buoyancy", DENSITY, "Buoyancy")),
    "BuoyancyPlugin": lab(model=plugin("libBuoyancyPlugin.so", tags(fluid_density=40))),
    "WindEffects": lab(world=gz("wind-effects", WIND + tags(force_approximation_scaling_factor=0.5), "WindEffects")),
    "WindPlugin": lab(world=plugin("libWindPlugin.so", WIND) + gz("wind-effects", "", "WindEffects")),
    "DetachableJoint": lab(
        world=BALL,
        model=gz("detachable-joint", tags(parent_link="base", child_model="load", child_link="l"), "DetachableJoint"),
    ),
    "GazeboRosVacuumGripper": lab(model=ros("vacuum_gripper", tags(link_name="base", max_distance=1.5))),
    "LinearBattery": lab(model=gz("linearbatteryplugin", BATTERY, "LinearBatteryPlugin")),
    "ClassicLinearBattery": lab(model=plugin("libLinearBatteryPlugin.so", tags(link_name="base") + BATTERY)),
    "LinearBatteryConsumer": lab(
        model=gz("linearbatteryplugin", BATTERY, "LinearBatteryPlugin")
        + plugin("libLinearBatteryConsumerPlugin.so", tags(link_name="base", battery_name="b", power_load=50))
    ),
    # ------------------------------------------------------------------ underwater vehicles
    "UnderwaterCurrent": uuv.world(DRIFT),
    "UnderwaterObject": _swimming("", depth=0.3).replace("<fluid_density>", "<debug>1</debug><fluid_density>"),
    "UuvThruster": _swimming(uuv.THRUSTER.format(dynamics=uuv.FIRST, conversion=uuv.BASIC, more=tags(gain=100))),
    "UuvFin": _swimming(uuv.FIN.format(dynamics=uuv.FIRST)),
    "UuvJointStates": _swimming(
        plugin("libuuv_joint_state_publisher.so")
        + uuv.THRUSTER.format(dynamics=uuv.FIRST, conversion=uuv.BASIC, more="")
    ),
    "UuvImu": _underwater_sensor("imu"),
    "UuvPose": _underwater_sensor("pose_gt", "<publish_ned_odom>1</publish_ned_odom>"),
    "UuvMagnetometer": _underwater_sensor("magnetometer"),
    "UuvDvl": _underwater_sensor("dvl", BEAMS),
    "SubseaPressure": _underwater_sensor("subsea_pressure"),
    "AcousticPosition": _underwater_sensor("rpt"),
    "SphericalCoordinatesServices": lab(world=plugin("libuuv_sc_ros_interface_plugin.so")),
    "DaveSphericalCoordinatesServices": lab(world=plugin("libdave_sc_coordinates_interface.so")),
    "DvlBridge": lab(model=plugin("DVLBridge", tags(topic="dvl"), "dave_ros_gz_plugins::DVLBridge")),
    # ------------------------------------------------------------------ messages by radio and sound
    **dict.fromkeys(("CommsEndpoint", "PerfectComms"), _talking("perfect", "Perfect", "", 5)),
    "RfComms": _talking("rf", "RF", RADIO, 300),
    "AcousticComms": _talking(
        "acoustic",
        "Acoustic",
        tags(speed_of_sound=100, collision_time_per_byte=0.01, collision_time_packet_drop=0.01)
        + tags(propagation_model=tags(seed=4)),
        40,
    ),
    **dict.fromkeys(
        ("RfRange", "RfRangeSensor"),
        lab(
            world=plugin("libRFRange.so", tags(update_rate=50) + RADIO, "gz::sim::systems::RFRange")
            + BALL.replace("</model>", plugin("libRFRange.so", "", "gz::sim::systems::RFRangeSensor") + "</model>"),
            model=plugin("libRFRange.so", "", "gz::sim::systems::RFRangeSensor"),
        ),
    ),
    # ------------------------------------------------------------------ publishers and monitors
    "OdometryPublisher": lab(model=gz("odometry-publisher", tags(gaussian_noise=0.1), "OdometryPublisher")),
    "PosePublisher": lab(
        model=gz("pose-publisher", tags(use_pose_vector_msg="true", update_frequency=50), "PosePublisher")
    ),
    "GazeboRosP3D": lab(model=ros("p3d", tags(body_name="base", gaussian_noise=0.01, update_rate=50))),
    "GazeboWorldOdometry": lab(
        model=plugin("libgazebo_world_odometry.so", tags(bodyName="base", topicName="truth", gaussian_noise=0.01))
    ),
    "GazeboRosImu": lab(model=ros("imu", tags(bodyName="base", topicName="imu", gaussianNoise=0.5))),
    "GazeboRosF3D": lab(model=ros("f3d", tags(bodyName="rod", topicName="force"))),
    "GazeboRosFtSensor": lab(model=ros("ft_sensor", tags(joint_name="arm", update_rate=50, gaussian_noise=0.1))),
    "KineticEnergyMonitor": lab(
        model=gz("kinetic-energy-monitor", tags(link_name="rod", kinetic_energy_threshold=1e-9), "KineticEnergyMonitor")
    ),
    "PerformerDetector": lab(
        world='<plugin name="gz::sim" filename="dummy"><performer name="p"><ref>crate</ref>'
        "<geometry><box><size>.3 .3 .3</size></box></geometry></performer></plugin>",
        model=gz("performer-detector", "<geometry><box><size>4 4 0.7</size></box></geometry>", "PerformerDetector"),
    ),
    "TouchPlugin": lab(
        world=PAD
        + gz("touchplugin", tags(target="ground", time=0.05, namespace="n", enabled="true"), "TouchPlugin")
        + "</model>"
    ),
    "ClassicTouchPlugin": lab(
        world=PAD
        + plugin("libTouchPlugin.so", tags(sensor="s", target="ground", time=0.05, namespace="n", enabled=1))
        + "</model>"
    ),
    "TriggeredPublisher": lab(
        world=gz(
            "triggered-publisher",
            '<input type="gz.msgs.Twist" topic="/in"/><output type="gz.msgs.Double" topic="/out">data: 2</output>'
            + tags(delay_ms=7),
            "TriggeredPublisher",
        )
    ),
    "SolarSensor": lab(model=plugin("libsolar_sensor.so", tags(light_name="sun", rpy_noise=0.1, update_rate=50))),
    "MapServer": lab(world=plugin("libsimkit_map_server.so", tags(height=0.05))),
    "MapSaver": lab(world=plugin("libsimkit_map_server.so", tags(height=0.05)) + plugin("libsimkit_map_saver.so")),
    "Amcl": rooms("<set_initial_pose>true</set_initial_pose><initial_pose><x>1</x><y>1</y></initial_pose>"),
    **dict.fromkeys(
        ("BehaviorServer", "ControllerServer", "Costmap2D", "FakeLocalization", "PlannerServer", "SmootherServer"),
        lab(world=NAVIGATION, model=ODOMETRY),
    ),
    "BtNavigator": lab(world=NAVIGATION + NAVIGATOR, model=ODOMETRY),
    "WaypointFollower": lab(world=NAVIGATION + NAVIGATOR + FOLLOWER, model=ODOMETRY),
    "TurtleSim": lab(world=plugin("libsimkit_turtlesim.so")),
    "TurtleMimic": lab(
        world=plugin("libsimkit_turtlesim.so")
        + plugin("libsimkit_turtle_mimic.so", "<ros><remapping>input/pose:=turtle1/pose</remapping></ros>")
    ),
    "EkfNode": lab(
        model=ros("p3d", tags(body_name="base", frame_name="odom", gaussian_noise=0.01, update_rate=50)),
        world=plugin("libsimkit_robot_localization.so", EKF, "ekf_filter_node"),
    ),
    "Sun": lab(
        world=plugin("simkit-sun", tags(start="2024-06-21T10:30:00Z", time_scale=600, update_rate=50), "simkit::Sun")
    ),
    "GazeboRosState": lab(world=ros("state", tags(update_rate=50))),
    "GazeboRosProperties": lab(world=ros("properties")),
    # ------------------------------------------------------------------ plugins of sensors
    "GazeboRosBumper": lab(sensor=CONTACT.format("<update_rate>50</update_rate>" + ros("bumper"))),
    "GazeboRosImuSensor": sensed("imu", ros("imu_sensor")),
    "GazeboRosGpsSensor": sensed("gps", ros("gps_sensor")),
    "GazeboRosRange": sensed("ray", ros("range", tags(gaussianNoise=0.02, updateRate=50, topicName="front"))),
    "GazeboRosLaser": sensed("ray", ros("laser", tags(topicName="scan", gaussianNoise=0.01))),
    "GazeboRosBlockLaser": sensed("ray", ros("block_laser", tags(topicName="cloud", gaussianNoise=0.01))),
    "GazeboRosVelodyneLaser": sensed(
        "ray", plugin("libgazebo_ros_velodyne_laser.so", tags(topicName="cloud", gaussianNoise=0.01))
    ),
    "GazeboRosRaySensor": sensed("ray", ros("ray_sensor", tags(output_type="sensor_msgs/LaserScan"))),
    "GazeboRosCamera": sensed("camera", ros("camera", tags(camera_name="front", triggered="true"))),
    "GazeboRosProsilica": sensed("camera", ros("prosilica", tags(cameraName="p", pollServiceName="request_image"))),
    "GazeboRosTriggeredCamera": sensed("camera", ros("triggered_camera", tags(cameraName="c", triggerTopicName="go"))),
    "GazeboRosDepthCamera": sensed("depth", ros("depth_camera", tags(cameraName="d", pointCloudTopicName="points"))),
    "GazeboRosOpenniKinect": sensed("depth", ros("openni_kinect", tags(cameraName="k"))),
    "GazeboRosMultiCamera": sensed("multicamera", ros("multicamera", tags(cameraName="stereo"))),
    "GazeboRosTriggeredMultiCamera": sensed("multicamera", ros("triggered_multicamera", tags(cameraName="stereo"))),
    "RealSense": lab(
        sensor=REALSENSE,
        model=plugin(
            "librealsense_gazebo_plugin.so",
            tags(prefix="d435", depthUpdateRate=50, colorUpdateRate=50, colorTopicName="color", depthTopicName="depth"),
        ),
    ),
    "ThermalSensor": sensed(
        "thermal", gz("thermal-sensor", tags(min_temp=250, max_temp=670, resolution=3), "ThermalSensor")
    ),
    "Thermal": sensed("thermal", visual=gz("thermal", tags(temperature=350), "Thermal")),
    "Label": sensed("segmentation", visual=gz("label", tags(label=20), "Label")),
    "SensorsSystem": sensed("camera", world=gz("sensors", tags(background_color="0.2 0.5 0.7"), "Sensors")),
    "MagnetometerSystem": sensed("magnetometer", world=gz("magnetometer", "", "Magnetometer")),
    "BuiltInSystem": lab(world=gz("physics", "", "Physics")),
    # ------------------------------------------------------------------ cameras, cars, feet and obstacles
    "CameraZoom": sensed("camera", plugin("CameraZoomPlugin", tags(topic="zoom", slew_rate=5)), world=ZOOM),
    "GstCamera": sensed("camera", plugin("GstCameraPlugin", tags(udp_port=5611))),
    "Px4GstCamera": sensed("camera", plugin("libgazebo_gst_camera_plugin.so", tags(udpPort=5613))),
    "ParticleEmitter": lab(sensor=SMOKE),
    "PriusHybridPlugin": lab(model=plugin("libPriusHybridPlugin.so", PRIUS)),
    "Teeterbot": lab(model=plugin("libteeterbot_gazebo_plugin.so", tags(speedMode=1)))
    .replace("rl_joint", "left_wheel_joint")
    .replace("rr_joint", "right_wheel_joint")
    .replace('"base"', '"base_link"')
    .replace(">base<", ">base_link<"),
    "TrafficBar": CROSSING,
    "UnitreeFootContact": lab(
        world=PAD.replace("</contact>", "</contact>" + plugin("libunitreeFootContactPlugin.so")) + "</model>"
    ),
    "Turtlebot3Obstacle": lab(model=plugin("libobstacle1.so")),
}
WORLDS["Performers"] = WORLDS["PerformerDetector"]


CONTROLLERS = """
controller_manager:
  ros__parameters:
    update_rate: 100
    arm: {type: effort_controllers/JointGroupPositionController}
    jsb: {type: joint_state_broadcaster/JointStateBroadcaster}
arm:
  ros__parameters:
    joints: [j1, j2]
    gains:
      j1: {p: 200.0, i: 50.0, d: 10.0}
      j2: {p: 100.0, i: 50.0, d: 5.0}
"""


def _control(library: str) -> Callable[[Path], simkit.Simulation]:
    hardware = "".join(f'<joint name="{j}">{control_robots.interfaces(("effort",))}</joint>' for j in ("j1", "j2"))
    return lambda folder: control_robots.opened(folder, control_robots.arm(hardware, library=library), CONTROLLERS)


def _ros_1(folder: Path) -> simkit.Simulation:
    gains = "    pid: {p: 300.0, i: 50.0, d: 20.0, i_clamp: 30.0}\n"
    kind = "effort_controllers/JointPositionController"
    return control_robots.opened(folder, ros_1.robot("EffortJointInterface"), ros_1.yaml(kind, gains))


def _fetch(folder: Path) -> simkit.Simulation:
    return fetch.load(folder)


def _motion(folder: Path) -> simkit.Simulation:
    return planar_arm.load(folder)


def _motion_planning(folder: Path) -> simkit.Simulation:
    (folder / "controllers.yaml").write_text(planar_arm.CONTROLLERS)
    planner = plugin("libsimkit_move_group.so", name="move_group")
    (folder / "lab.sdf").write_text(planar_arm.world(planar_arm.model(extra=planner)))
    return simkit.load(folder / "lab.sdf")


def _python_system(folder: Path) -> simkit.Simulation:
    (folder / "counter.py").write_text(COUNTER)
    text = lab(model=gz("python-system-loader", tags(module_name="counter"), "PythonSystemLoader"))
    return simkit.load(text, plugin_paths=[folder])


def _log(kind: str) -> Callable[[Path], simkit.Simulation]:
    tag = "record_path" if kind == "LogRecord" else "playback_path"
    return lambda folder: simkit.load(lab(world=gz("log", f"<{tag}>{folder / 'log'}</{tag}>", kind)))


def _baxter(folder: Path) -> simkit.Simulation:
    text = (ROOT / "assets" / "baxter" / "model.sdf").read_text(encoding="utf-8")
    return simkit.load(text.replace("<initial_positions>", "<enabled>true</enabled><initial_positions>"))


def _traffic_light(folder: Path) -> simkit.Simulation:
    return simkit.load(traffic.write_world(folder, SLOW))


AUV = f"""<robot name="auv"><link name="base_link"><inertial><mass value="20"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial><fluid><density>1</density>
    <origin xyz="0 0 0.1"/><buoyancy><compensation>1.1</compensation><limit radius="0.2"/></buoyancy><hydrodynamics>
    <damping xyz="40 40 40" rpy="20 20 20"/><added_mass>{"9 0 0 0 0 0 0 " * 5} 9</added_mass></hydrodynamics></fluid>
  </link><link name="rod"><inertial><mass value="0.1"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="arm" type="continuous"><parent link="base_link"/><child link="rod"/><axis xyz="0 0 1"/></joint>
  <gazebo><plugin name="c" filename="libfreefloating_gazebo_control.so"><updateRate>50</updateRate>
    <link>base_link</link><thruster><map>1 0 0 0 0 -0.5</map><effort>0.2</effort></thruster>
    <thruster><map>1 0 0 0 0 0.5</map><name>arm</name></thruster></plugin></gazebo></robot>"""


def _diving(folder: Path) -> simkit.Simulation:
    (folder / "auv.urdf").write_text(AUV)
    water = plugin("libfreefloating_gazebo_fluid.so", tags(surface="0 0 0"))
    diver = "<include><uri>auv.urdf</uri><pose>0 -3 -0.2 0.1 0.2 0</pose></include>"
    return simkit.load(
        f'<sdf version="1.9"><world name="w">{water}{diver}</world></sdf>', seed=3, resource_paths=[folder]
    )


def _livox(folder: Path) -> simkit.Simulation:
    rows = "".join(f"{i},{i * 37 % 360},{80 + i % 20}\n" for i in range(50))
    (folder / "rows.csv").write_text("Time/s,Azimuth/deg,Zenith/deg\n" + rows, encoding="utf-8")
    text = tags(samples=8, csv_file_name="rows.csv", ros_topic="cloud")
    text += "<ray><range><min>0.1</min><max>20</max></range></ray>"
    sensor = f'<sensor name="livox" type="ray"><update_rate>50</update_rate>{plugin("libros2_livox.so", text)}</sensor>'
    (folder / "lab.sdf").write_text(lab(sensor=sensor), encoding="utf-8")
    return simkit.load(folder / "lab.sdf", seed=3)


OPENED: dict[str, Callable[[Path], simkit.Simulation]] = {
    "GazeboRos2Control": _control(control_robots.CLASSIC),
    "GzRos2Control": _control("libgz_ros2_control-system.so"),
    "GazeboRosControl": _ros_1,
    "FetchGazeboPlugin": _fetch,
    "BaxterControl": _baxter,
    "LeggedControl": lambda folder: gain_commands.load_legged(folder, ("effort", "kd")),
    "Pr2ControlPlugin": pr2.load,
    "TrafficLight": _traffic_light,
    "PlayMotion": _motion,
    "MoveGroup": _motion_planning,
    "PythonSystemLoader": _python_system,
    "FreefloatingControl": _diving,
    "FreefloatingFluid": _diving,
    "LivoxLaser": _livox,
    "LogRecord": _log("LogRecord"),
    "LogPlayback": _log("LogPlayback"),
}
"""Test worlds of plugins that need files."""


@dataclass(frozen=True)
class Idle:
    """Plugin without attributes, messages and effects on the physics."""

    why: str


IDLE: dict[str, Idle] = {
    "GstCamera": Idle("sends a video beside the run"),
    "Px4GstCamera": Idle("sends a video beside the run"),
    "WavefieldModelPlugin": Idle("sets the waves for the plugins of boats, when the world is loaded"),
    "AsvAnemometerSystem": Idle("stands for what the sensor does anyway"),
    "RotorsInterface": Idle("stands for what the rotors do anyway"),
    "LightBuoy": Idle("changes colours, which the camera of its world sees"),
    "CreateWheelDrop": Idle("sees no wheel that has dropped here; its test moves a wheel"),
    "MimicJoint": Idle("couples joints, when the world is loaded"),
    "GazeboLinkAttacher": Idle("attaches nothing here; its test calls its services"),
    "GazeboRosLinkAttacher": Idle("attaches nothing here; its test calls its services"),
    "MapSaver": Idle("writes nothing here; its test calls its service"),
    "MapServer": Idle("publishes its map when the world is loaded; its test loads others"),
    "MoveGroup": Idle("waits for requests here; its test plans"),
    "GraspFix": Idle("attaches nothing here; its test lifts a cube"),
    "ArduPilotPlugin": Idle("waits for an autopilot here; its test plays one"),
    "GazeboMavlinkInterface": Idle("waits for an autopilot here; its test plays one"),
    "Px4Wind": Idle("moves the air, which only other plugins and sensors feel"),
    "SphericalCoordinatesServices": Idle("answers services"),
    "DaveSphericalCoordinatesServices": Idle("answers services"),
    "PerfectComms": Idle("passes messages on at once; the endpoints publish them"),
    "DvlBridge": Idle("stands for a bridge, whose message the sensor publishes itself"),
    "MultirotorBase": Idle("stands for a plugin of PX4 that only publishes"),
    "Px4GroundTruth": Idle("stands for a plugin of PX4 that only publishes"),
    "BuiltInSystem": Idle("stands for what simkit does anyway"),
    "MagnetometerSystem": Idle("tells sensors how they measure, when the world is loaded"),
    "SensorsSystem": Idle("sets colours of the sky, when the world is loaded"),
    "Label": Idle("names things for cameras, when the world is loaded"),
    "Thermal": Idle("warms things for cameras, when the world is loaded"),
    "ThermalSensor": Idle("sets up a camera, when the world is loaded"),
    "LogPlayback": Idle("is told to be of no effect"),
    "LogRecord": Idle("writes a bag beside the run"),
    "Performers": Idle("says who may be detected"),
    "GazeboRosProperties": Idle("answers services"),
}
"""Plugins without messages, forces and attributes; the tests check that they change nothing."""


def open_world(name: str, folder: Path) -> simkit.Simulation:
    """Load the test world of a plugin class."""
    return OPENED[name](folder) if name in OPENED else simkit.load(WORLDS[name], seed=3)
