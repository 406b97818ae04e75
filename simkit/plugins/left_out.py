"""Plugins of Gazebo that simkit leaves out, and why: what a file that names one is told, and `docs/catalogue.md`."""

from __future__ import annotations

from types import MappingProxyType
from typing import Final

_GZ: Final = (
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

_CLASSIC: Final = (
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


def _table() -> dict[str, str]:
    found: dict[str, str] = {}
    for reason, names in _GZ:
        for file_and_class in names.split():
            part, _, cls = file_and_class.partition(":")
            found[f"gz-sim-{part}-system"] = found[f"gz::sim::systems::{cls}"] = reason
    for reason, names in _CLASSIC:
        found.update(dict.fromkeys(names.split(), reason))
    return found


LEFT_OUT: Final = MappingProxyType(_table())
"""Normalised names (`simkit.plugins.normalise`) of libraries and of gz classes, and why they are left out."""
