"""Models in MuJoCo's own format. The scene describes them, and MuJoCo's specification is kept as well."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from simkit.pose import IDENTITY, Pose

Mass = tuple[float, tuple[float, ...], tuple[float, ...], tuple[float, ...]]


@dataclass(frozen=True, slots=True)
class MjcfGeom:
    """Link and purpose of a geom.

    Attributes:
        link: scoped name of its link.
        shape: scoped name of the collision, or of the visual if the geom is only drawn.
        collides, drawn: uses of the geom; it can have both, or neither (the geom then only adds mass).
    """

    link: str
    shape: str
    collides: bool
    drawn: bool


@dataclass(frozen=True, slots=True, eq=False)
class MjcfElements:
    """Mapping between the elements of the scene and those of the MJCF file.

    Attributes:
        bodies: scoped link -> body; `world` for the link that holds the content of the file's world body.
        joints: scoped joint -> joint; empty for a fixed one.
        free: scoped link -> free joint.
        geoms: geom -> its link and purpose.
        lights: scoped light -> (light, its link or empty).
        masses: body -> mass [kg], centre of mass [m], axes of inertia as a quaternion, principal moments [kg·m²].
    """

    bodies: dict[str, str] = field(default_factory=dict)
    joints: dict[str, str] = field(default_factory=dict)
    free: dict[str, str] = field(default_factory=dict)
    geoms: dict[str, MjcfGeom] = field(default_factory=dict)
    lights: dict[str, tuple[str, str]] = field(default_factory=dict)
    masses: dict[str, Mass] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MjcfSource(MjcfElements):
    """MuJoCo's own description of a model, with the mapping of its elements to those of the scene.

    Attributes:
        document: function that returns a new specification of the whole file (an `mujoco.MjSpec`) with names for all
            elements.
        place: pose of the file's world in the world frame at load time.
        prefix: prefix of all names in the compiled world; empty for a file that is the world itself.
        roots: names, as in the file, of the top-level bodies that belong to this model.
        base: "auto" keeps the free joints of the file, "fixed" removes them, "floating" adds missing ones.
        settings: engine settings of the file by element (`option`, `visual`, ...), with their lines.
        as_read: the model as the file describes it, under an empty name. The compiler writes the differences of a
            changed model to the specification.
    """

    document: Callable[[], Any]
    place: Pose = IDENTITY
    prefix: str = ""
    roots: tuple[str, ...] = ()
    base: str = "auto"
    settings: Mapping[str, Any] = field(default_factory=dict)
    as_read: dict[str, Any] = field(default_factory=dict, repr=False)
