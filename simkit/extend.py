"""Names for those who extend simkit: base classes of plugins, sensors and formats, their options, topics and helpers.

Packs, plugins and sensors need this module, `simkit` and `simkit.msgs`. Its names stay as they are within a minor
version. `docs/extend.md` explains each of them.

    from simkit.extend import Options, OptionsOf, number

    class FanOptions(Options):
        speed: float = number(0.5, "rad/s", minimum=0.0)
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit.lazy_names import lazy_attributes

if TYPE_CHECKING:
    from simkit.cli.run_options import GivenOptions, with_run_options
    from simkit.cli.run_part import OpenRun, RunPart
    from simkit.cli.terminal.json_report import add_to_report, report_errors
    from simkit.cli.terminal.options import argument, option
    from simkit.compiler import Compiled, SpecBuilder
    from simkit.diagnostics import Diagnostics, Where, did_you_mean
    from simkit.loaders.resources.loader import Loader, LoadRequest
    from simkit.loaders.resources.xml_reader import Document
    from simkit.number_text import counted
    from simkit.params import LARGEST
    from simkit.plugins.base import NEVER
    from simkit.plugins.base import Plugin as Plugin  # for type checkers alone; users import it from `simkit`
    from simkit.plugins.endpoints import acts, listens, offers, publishes
    from simkit.plugins.find_entities import find_link, find_named_joint, find_named_link
    from simkit.plugins.joints.joint_axis import JointAxis
    from simkit.plugins.not_deep_copied import SharedByCopies
    from simkit.plugins.options import (
        Options,
        OptionsOf,
        block,
        blocks,
        boolean,
        choice,
        integer,
        number,
        pose,
        text,
        texts,
        vector3,
        without_effect,
    )
    from simkit.plugins.publish_on_demand import publish_while_subscribed
    from simkit.pose import Vector
    from simkit.runtime.communication.action_server import GoalHandle
    from simkit.runtime.communication.service_server import ServiceCall
    from simkit.runtime.engine.random_streams import RandomStream
    from simkit.scene import (
        Box,
        Cylinder,
        Inertial,
        Scene,
        SceneCollision,
        SceneJoint,
        SceneLink,
        SceneModel,
        SceneSensor,
        SceneVisual,
        SceneWorld,
        Sphere,
    )
    from simkit.sensors.artefacts import Artefact, MessageArtefact
    from simkit.sensors.base import Product, Sensor
    from simkit.sensors.cameras.image_noise import CameraReading, ChangedReading
    from simkit.sensors.environment.navsat import NavSat, NavSatReading
    from simkit.sensors.inertial.imu_measurement import ImuMeasurement, ImuReading
    from simkit.sensors.noise import Noise, NoiseModel, quantise, read_noise
    from simkit.sensors.rays.lidar_measurement import LidarMeasurement, LidarReading
    from simkit.sensors.vector_sensor import VectorRule, VectorSensor

__all__ = [
    "LARGEST",
    "NEVER",
    "Artefact",
    "Box",
    "CameraReading",
    "ChangedReading",
    "Compiled",
    "Cylinder",
    "Diagnostics",
    "Document",
    "GivenOptions",
    "GoalHandle",
    "ImuMeasurement",
    "ImuReading",
    "Inertial",
    "JointAxis",
    "LidarMeasurement",
    "LidarReading",
    "LoadRequest",
    "Loader",
    "MessageArtefact",
    "NavSat",
    "NavSatReading",
    "Noise",
    "NoiseModel",
    "OpenRun",
    "Options",
    "OptionsOf",
    "Product",
    "RandomStream",
    "RunPart",
    "Scene",
    "SceneCollision",
    "SceneJoint",
    "SceneLink",
    "SceneModel",
    "SceneSensor",
    "SceneVisual",
    "SceneWorld",
    "Sensor",
    "ServiceCall",
    "SharedByCopies",
    "SpecBuilder",
    "Sphere",
    "Vector",
    "VectorRule",
    "VectorSensor",
    "Where",
    "acts",
    "add_to_report",
    "argument",
    "block",
    "blocks",
    "boolean",
    "choice",
    "counted",
    "did_you_mean",
    "find_link",
    "find_named_joint",
    "find_named_link",
    "integer",
    "listens",
    "number",
    "offers",
    "option",
    "pose",
    "publish_while_subscribed",
    "publishes",
    "quantise",
    "read_noise",
    "report_errors",
    "text",
    "texts",
    "vector3",
    "with_run_options",
    "without_effect",
]

_MODULES = {
    "simkit.cli.run_options": ("GivenOptions", "with_run_options"),
    "simkit.cli.run_part": ("OpenRun", "RunPart"),
    "simkit.cli.terminal.json_report": ("add_to_report", "report_errors"),
    "simkit.cli.terminal.options": ("argument", "option"),
    "simkit.compiler": ("Compiled", "SpecBuilder"),
    "simkit.diagnostics": ("Diagnostics", "Where", "did_you_mean"),
    "simkit.number_text": ("counted",),
    "simkit.loaders.resources.loader": ("LoadRequest", "Loader"),
    "simkit.loaders.resources.xml_reader": ("Document",),
    "simkit.params": ("LARGEST",),
    "simkit.plugins.base": ("NEVER",),
    "simkit.plugins.endpoints": ("acts", "listens", "offers", "publishes"),
    "simkit.plugins.find_entities": ("find_link", "find_named_joint", "find_named_link"),
    "simkit.plugins.joints.joint_axis": ("JointAxis",),
    "simkit.plugins.not_deep_copied": ("SharedByCopies",),
    "simkit.plugins.options": (
        "Options", "OptionsOf", "block", "blocks", "boolean", "choice", "integer", "number", "pose", "text", "texts",
        "vector3", "without_effect",
    ),
    "simkit.plugins.publish_on_demand": ("publish_while_subscribed",),
    "simkit.pose": ("Vector",),
    "simkit.runtime.communication.action_server": ("GoalHandle",),
    "simkit.runtime.communication.service_server": ("ServiceCall",),
    "simkit.scene": (
        "Box", "Cylinder", "Inertial", "Scene", "SceneCollision", "SceneJoint", "SceneLink", "SceneModel",
        "SceneSensor", "SceneVisual", "SceneWorld", "Sphere",
    ),
    "simkit.runtime.engine.random_streams": ("RandomStream",),
    "simkit.sensors.artefacts": ("Artefact", "MessageArtefact"),
    "simkit.sensors.cameras.image_noise": ("CameraReading", "ChangedReading"),
    "simkit.sensors.environment.navsat": ("NavSat", "NavSatReading"),
    "simkit.sensors.inertial.imu_measurement": ("ImuMeasurement", "ImuReading"),
    "simkit.sensors.rays.lidar_measurement": ("LidarMeasurement", "LidarReading"),
    "simkit.sensors.base": ("Product", "Sensor"),
    "simkit.sensors.noise": ("Noise", "NoiseModel", "quantise", "read_noise"),
    "simkit.sensors.vector_sensor": ("VectorRule", "VectorSensor"),
}  # fmt: skip

if not TYPE_CHECKING:  # hidden from type checkers, so that they report unknown names
    __getattr__, __dir__ = lazy_attributes(__name__, _MODULES)
