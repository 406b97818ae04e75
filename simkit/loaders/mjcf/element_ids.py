"""What of a file becomes one model, and which of its elements are which of that model's."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from simkit.diagnostics import Where
from simkit.pose import IDENTITY, Pose
from simkit.scene import ScenePlugin
from simkit.scene.mjcf_source import Mass, MjcfGeom


@dataclass(frozen=True)
class ModelPlacement:
    """What becomes one model, and where.

    Attributes:
        roots: ids of its top-level bodies.
        has_world: whether what stands in the world body is its too.
        frame: the model frame in the file's world.
        pose_world: the model frame in the world.
        prefix: of its names in the compiled world.
        strip: beginning of the file's names that is left out of the scene's.
    """

    name: str
    scoped: str
    roots: Sequence[int]
    has_world: bool
    frame: Pose = IDENTITY
    pose_world: Pose = IDENTITY
    prefix: str = ""
    strip: str = ""
    static: bool = False
    base: str = "auto"
    plugins: tuple[ScenePlugin, ...] = ()
    where: Where | None = None


@dataclass
class ElementIds:
    """Which element of the file each part of a model is."""

    bodies: dict[str, str] = field(default_factory=dict)
    joints: dict[str, str] = field(default_factory=dict)
    free: dict[str, str] = field(default_factory=dict)
    geoms: dict[str, MjcfGeom] = field(default_factory=dict)
    lights: dict[str, tuple[str, str]] = field(default_factory=dict)
    masses: dict[str, Mass] = field(default_factory=dict)
