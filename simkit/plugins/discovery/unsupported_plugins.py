"""List the plugins that come with Gazebo, and say why simkit leaves some of them out."""

from __future__ import annotations

from types import MappingProxyType
from typing import Final

_GZ_SYSTEMS = """
ackermann-steering acoustic-comms advanced-lift-drag air-pressure air-speed altimeter apply-joint-force
apply-link-wrench linearbatteryplugin breadcrumbs buoyancy buoyancy-engine camera-video-recorder
collada-world-exporter comms-endpoint contact cpu-lidar detachable-joint diff-drive drive-to-pose-controller dvl
elevator entity-semantics environment-preload environmental-sensor follow-actor forcetorque free-space-explorer
hydrodynamics imu joint-controller joint-position-controller joint-state-publisher joint-trajectory-controller
kinetic-energy-monitor label led-plugin lens-flare lift-drag lighter_than_air_dynamics log log-video-recorder
logicalaudiosensorplugin logical-camera lookup-wheel-slip magnetometer mecanum-drive model-photo-shoot
multicopter-control multicopter-motor-model navsat odometry-publisher opticaltactileplugin particle-emitter
perfect-comms performer-detector physics pose-publisher python-system-loader rf-comms scene-broadcaster sensors
shader-param spacecraft-thruster-model thermal thermal-sensor thruster touchplugin track-controller tracked-vehicle
trajectory-follower triggered-publisher user-commands velocity-control websocket-server wheel-slip wind-effects
"""

_CLASSIC_ROS = """
ackermann_drive block_laser bumper camera camera_utils control depth_camera diff_drive elevator f3d factory force
force_system ft_sensor gpu_laser gps_sensor hand_of_god harness imu imu_sensor init joint_pose_trajectory
joint_state_publisher laser multicamera openni_kinect p3d planar_move projector properties prosilica range
ray_sensor skid_steer_drive state template tricycle_drive triggered_camera triggered_multicamera vacuum_gripper
video wheel_slip
"""

_CLASSIC = """
ActorPlugin AmbientOcclusionVisualPlugin ArduCopterPlugin BlinkVisualPlugin BuoyancyPlugin CameraPlugin
CartDemoPlugin ContactPlugin DepthCameraPlugin DiffDrivePlugin ElevatorPlugin FlashLightPlugin ForceTorquePlugin
GimbalSmall2dPlugin GpuRayPlugin GravityCompensationPlugin HarnessPlugin HydraPlugin ImuSensorPlugin
InitialVelocityPlugin JointControlPlugin JointTrajectoryPlugin KeysToCmdVelPlugin KeysToJointsPlugin LedPlugin
LiftDragPlugin LinearBatteryPlugin LinearBatteryConsumerPlugin MisalignmentPlugin ModelPropShop MudPlugin
PlaneDemoPlugin PressurePlugin RandomVelocityPlugin RayPlugin RaySensorNoisePlugin RubblePlugin ShaderParamVisualPlugin
SimEventsPlugin SkidSteerDrivePlugin SonarPlugin SphereAtlasDemoPlugin TouchPlugin TrackedVehiclePlugin
VariableGearboxPlugin VehiclePlugin WheelSlipPlugin WheelTrackedVehiclePlugin WindPlugin
"""

GAZEBO_PLUGINS: frozenset[str] = frozenset(
    [f"gz-sim-{name}-system" for name in _GZ_SYSTEMS.split()]
    + [f"gazebo_ros_{name}" for name in _CLASSIC_ROS.split()]
    + ["gazebo_ros2_control", "gz_ros2_control-system", "gz_ros_control-system"]
    + _CLASSIC.split()
)
"""Normalised library names (`simkit.plugins.normalise`)."""


_UNSUPPORTED_GZ: Final = (
    (
        "flight and fluids beyond lift, drag and buoyancy belong to another kind of vehicle",
        """
        advanced-lift-drag:AdvancedLiftDrag buoyancy-engine:BuoyancyEngine hydrodynamics:Hydrodynamics
        lighter_than_air_dynamics:LighterThanAirDynamics multicopter-control:MulticopterVelocityControl
        multicopter-motor-model:MulticopterMotorModel spacecraft-thruster-model:SpacecraftThrusterModel
        thruster:Thruster
        """,
    ),
    (
        "radio and sound between robots are not simulated: every topic reaches everyone at once",
        """
        acoustic-comms:AcousticComms comms-endpoint:CommsEndpoint perfect-comms:PerfectComms rf-comms:RFComms
        logicalaudiosensorplugin:LogicalAudioSensorPlugin
        """,
    ),
    (
        "it is an effect of Gazebo's renderer, which nothing but a picture shows",
        "led-plugin:LedPlugin lens-flare:LensFlare particle-emitter:ParticleEmitter shader-param:ShaderParam",
    ),
    (
        "pictures and films are taken from a camera's topic (`--record`) or with `--picture`, without a window",
        """
        camera-video-recorder:CameraVideoRecorder log-video-recorder:LogVideoRecorder
        model-photo-shoot:ModelPhotoShoot
        """,
    ),
    ("`simkit convert` writes a world for other programs", "collada-world-exporter:ColladaWorldExporter"),
    (
        "no port is opened; `simkit topic` and its like talk to a run over a local socket",
        "websocket-server:WebsocketServer",
    ),
    (
        "it takes its values from tables that are kept outside the world",
        """
        environment-preload:EnvironmentPreload environmental-sensor:EnvironmentalSystem
        lookup-wheel-slip:LookupWheelSlip
        """,
    ),
    ("a few lines of Python do it with `sim.spawn`", "breadcrumbs:Breadcrumbs"),
    ("it only gives words to entities, which nothing here asks for", "entity-semantics:EntitySemantics"),
    ("it is a demonstration that a robot's own program replaces", "free-space-explorer:FreeSpaceExplorer"),
    (
        "a contact sensor says what it does but for pictures of the pressure",
        "opticaltactileplugin:OpticalTactilePlugin",
    ),
)

_UNSUPPORTED_CLASSIC: Final = (
    (
        "it is an effect of Gazebo's renderer, which nothing but a picture shows",
        """
        gazebo_ros_projector gazebo_ros_video AmbientOcclusionVisualPlugin BlinkVisualPlugin FlashLightPlugin LedPlugin
        ShaderParamVisualPlugin
        """,
    ),
    (
        "it reads a device or a window of the machine; `simkit run --teleop` drives with the keyboard",
        "HydraPlugin KeysToCmdVelPlugin KeysToJointsPlugin",
    ),
    ("it hands a model to another program over a socket", "ArduCopterPlugin"),
    (
        "it makes joints while it runs; a joint controller winds a load, and gz's DetachableJoint lets it go",
        "gazebo_ros_harness HarnessPlugin",
    ),
    (
        "it is the base of SimpleTrackedVehiclePlugin and WheelTrackedVehiclePlugin, which are there",
        "TrackedVehiclePlugin",
    ),
    (
        "it is a library whose two plugins go by their classes, `gz::sim::systems::LogRecord` and `…LogPlayback`",
        "gz-sim-log-system",
    ),
    (
        "it is a demonstration of Gazebo's own, without topics",
        """
        gazebo_ros_template CartDemoPlugin MisalignmentPlugin ModelPropShop MudPlugin PlaneDemoPlugin RubblePlugin
        SphereAtlasDemoPlugin SimEventsPlugin RandomVelocityPlugin InitialVelocityPlugin RaySensorNoisePlugin
        """,
    ),
    (
        "what it does in Gazebo Classic's own messages, the plugin of gazebo_ros_pkgs or gz-sim of that name does here",
        """
        gazebo_ros_camera_utils ActorPlugin DiffDrivePlugin ForceTorquePlugin GimbalSmall2dPlugin
        GravityCompensationPlugin JointControlPlugin JointTrajectoryPlugin PressurePlugin SkidSteerDrivePlugin
        VariableGearboxPlugin VehiclePlugin
        """,
    ),
)


def _reasons_by_name() -> dict[str, str]:
    found: dict[str, str] = {}
    for reason, names in _UNSUPPORTED_GZ:
        for file_and_class in names.split():
            part, _, cls = file_and_class.partition(":")
            found[f"gz-sim-{part}-system"] = found[f"gz::sim::systems::{cls}"] = reason
    for reason, names in _UNSUPPORTED_CLASSIC:
        found.update(dict.fromkeys(names.split(), reason))
    return found


UNSUPPORTED_REASONS: Final = MappingProxyType(_reasons_by_name())
"""Normalised names (`simkit.plugins.normalise`) of libraries and of gz classes, and why they are left out."""
