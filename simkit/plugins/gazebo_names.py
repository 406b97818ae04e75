"""Names of plugins that come with Gazebo, so that one simkit does not have is told from a misspelt one."""

from __future__ import annotations

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

KNOWN: frozenset[str] = frozenset(
    [f"gz-sim-{name}-system" for name in _GZ_SYSTEMS.split()]
    + [f"gazebo_ros_{name}" for name in _CLASSIC_ROS.split()]
    + ["gazebo_ros2_control", "gz_ros2_control-system", "gz_ros_control-system"]
    + _CLASSIC.split()
)
"""Normalised library names (`simkit.plugins.normalise`)."""
