"""Changes to a file in MuJoCo's own format when it becomes part of another world.

The engine settings of the world replace those of the file. The geoms get friction priorities like all other geoms, so
that the smaller coefficient of two surfaces is used. A static model loses its joints. A base becomes fixed or free, as
the caller requires.
"""

from __future__ import annotations

from typing import Any, Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.contact_friction import MU_MOST, friction_priority
from simkit.compiler.kinematic_tree import WORLD
from simkit.compiler.state_transfer import JOINT_WIDTHS
from simkit.diagnostics import NOWHERE, Diagnostics
from simkit.number_text import counted
from simkit.scene import SceneModel
from simkit.scene.mjcf_source import MjcfSource

OPTIONS: Final = (
    "timestep", "impratio", "tolerance", "ls_tolerance", "noslip_tolerance", "ccd_tolerance", "sleep_tolerance",
    "gravity", "wind", "magnetic", "density", "viscosity", "o_margin", "o_solref", "o_solimp", "o_friction",
    "integrator", "cone", "jacobian", "solver", "iterations", "ls_iterations", "noslip_iterations",
    "ccd_iterations", "sdf_iterations", "sdf_initpoints", "disableflags", "enableflags", "disableactuator",
)  # fmt: skip
_GLOBAL: Final = (
    "nuserdata", "nkey", "memory", "njmax", "nconmax", "nemax", "nstack", "nuser_body", "nuser_jnt", "nuser_geom",
    "nuser_site", "nuser_cam", "nuser_tendon", "nuser_actuator", "nuser_sensor",
)  # fmt: skip
_VISUALS: Final = ("global_", "quality", "headlight", "map", "scale", "rgba")
_REPORTED_OPTIONS: Final = frozenset(
    ("gravity", "wind", "density", "viscosity", "o_margin", "o_solref", "o_solimp", "o_friction")
)
"""Options that change the meaning of a model; the others only set accuracy and speed."""

_FIRST: Final = friction_priority(0.0) + 1
"""Priority above the priorities of all friction coefficients, for geoms with a `priority` in their file."""


def copy_settings(source: mujoco.MjSpec, target: mujoco.MjSpec) -> None:
    """Copy sizes and visual settings of one specification to another."""
    for name in _GLOBAL:
        setattr(target, name, getattr(source, name))
    for group in _VISUALS:
        theirs, ours = getattr(source.visual, group), getattr(target.visual, group)
        for name in dir(theirs):
            if not name.startswith("_"):
                setattr(ours, name, getattr(theirs, name))


def match_settings(child: mujoco.MjSpec, spec: mujoco.MjSpec) -> None:
    """Give a file's specification the settings of the world, so that attaching has no settings to merge."""
    for name in OPTIONS:
        setattr(child.option, name, getattr(spec.option, name))
    copy_settings(spec, child)
    if child.compiler.autolimits:
        _write_inferred_limits(child)


def _write_inferred_limits(child: mujoco.MjSpec) -> None:
    """Write inferred limits explicitly, because an exported world has one `autolimits` setting for all models."""
    switches = {
        "joints": (("limited", "range"), ("actfrclimited", "actfrcrange")),
        "tendons": (("limited", "range"), ("actfrclimited", "actfrcrange")),
        "actuators": (("ctrllimited", "ctrlrange"), ("forcelimited", "forcerange"), ("actlimited", "actrange")),
    }
    for kind, pairs in switches.items():
        for element in getattr(child, kind):
            for switch, ends in pairs:
                if int(getattr(element, switch)) == int(mujoco.mjtLimited.mjLIMITED_AUTO):
                    low, high = getattr(element, ends)
                    setattr(element, switch, int(low < high))


def report_settings(child: mujoco.MjSpec, spec: mujoco.MjSpec, model: SceneModel, diagnostics: Diagnostics) -> None:
    """Report the settings of the file that the world's settings replace."""
    lost: dict[str, list[str]] = {"warning": [], "note": []}
    places = {"warning": NOWHERE, "note": NOWHERE}
    for name, place in model.mjcf.settings.items() if model.mjcf is not None else ():
        severity = "warning" if name in _REPORTED_OPTIONS or name.startswith("flag ") else "note"
        if name.startswith("flag "):
            mask = _flag(name.removeprefix("flag "))
            if not (int(child.option.disableflags) ^ int(spec.option.disableflags)) & mask:
                continue
            lost[severity].append(name)
        elif name in OPTIONS and not np.array_equal(getattr(child.option, name), getattr(spec.option, name)):
            theirs, ours = (_text(name, getattr(o, name)) for o in (child.option, spec.option))
            lost[severity].append(f"{name} {theirs} (here {ours})")
        else:
            continue
        places[severity] = place
    for severity, names in lost.items():
        if names:
            message = f"model {model.scoped}: the world's settings replace the file's {', '.join(names)}"
            diagnostics.add("warning" if severity == "warning" else "note", "SK-MJCF-009", message, places[severity])


def _flag(name: str) -> int:
    bit = getattr(mujoco.mjtDisableBit, f"mjDSBL_{name.upper()}", None)
    return 0 if bit is None or name == "autoreset" else int(bit)


_OPTION_NAMES: Final[dict[str, Any]] = {
    "integrator": mujoco.mjtIntegrator,
    "cone": mujoco.mjtCone,
    "solver": mujoco.mjtSolver,
    "jacobian": mujoco.mjtJacobian,
}


def _text(name: str, value: float | npt.NDArray[np.float64]) -> str:
    if name in _OPTION_NAMES:
        return str(_OPTION_NAMES[name](int(value)).name).split("_", 1)[1].lower()
    return " ".join(f"{float(v):g}" for v in np.ravel(value))


def rank_friction(child: mujoco.MjSpec, model: SceneModel, diagnostics: Diagnostics) -> None:
    """Give each geom a priority by its friction, like all other geoms of the world.

    Geoms with a priority in the file get a priority above all of these.
    """
    first = 0
    for geom in child.geoms:
        if int(geom.priority) > 0:
            first += 1
            geom.priority = _FIRST + min(int(geom.priority), 1 << 20)
        elif int(geom.priority) == 0:
            slides = float(geom.friction[0]) if int(geom.condim) > 1 else 0.0
            geom.priority = friction_priority(min(slides, MU_MOST))
    if first:
        message = f"model {model.scoped}: {first} geoms have a priority in the file, so their friction is always used"
        diagnostics.note("SK-MJCF-013", message, model.where)


def write_masses(child: mujoco.MjSpec, source: MjcfSource) -> None:
    """Write explicit masses and inertias, which in the file follow from geoms, mass bounds or a total mass."""
    for name, (mass, centre, axes, moments) in source.masses.items():
        body = child.body(name)
        body.explicitinertial = True
        body.mass, body.ipos, body.iquat, body.inertia = mass, centre, axes, moments
        body.fullinertia = np.full(6, np.nan)
        body.ialt.type = mujoco.mjtOrientation.mjORIENTATION_QUAT
    compiler = child.compiler
    compiler.inertiafromgeom = mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_FALSE
    compiler.settotalmass, compiler.boundmass, compiler.boundinertia = -1.0, 0.0, 0.0


def drop_lights(child: mujoco.MjSpec, model: SceneModel, diagnostics: Diagnostics) -> None:
    """Remove the lights of a file's own world, because the new world has its own."""
    lights = list(child.worldbody.lights)
    for light in lights:
        child.delete(light)
    if lights:
        message = f"model {model.scoped}: {counted(len(lights), 'light')} of the file's own world ignored"
        diagnostics.note("SK-MJCF-011", message, model.where)


def rename_lights(child: mujoco.MjSpec, source: MjcfSource, prefix: str = "") -> None:
    """Rename the lights on bodies to their scoped names."""
    for scoped, (name, link) in source.lights.items():
        if link:
            child.light(name).name = scoped.removeprefix(prefix)


def make_static(child: mujoco.MjSpec, model: SceneModel, diagnostics: Diagnostics) -> None:
    """Remove all joints of a static model, and all elements that move, couple or measure them."""
    removed = [f"{n} joints"] if (n := len(list(child.joints))) else []
    for kind in ("keys", "sensors", "actuators", "tendons", "equalities"):
        elements = list(getattr(child, kind))
        if elements:
            removed.append(f"{len(elements)} {kind}")
        for element in elements:
            child.delete(element)
    for joint in list(child.joints):
        child.delete(joint)
    for body in list(child.bodies)[1:]:
        body.mocap = False
    if removed:
        message = f"model {model.scoped} is static: its {', '.join(removed)} are ignored"
        diagnostics.note("SK-MJCF-012", message, model.where)


def set_base(child: mujoco.MjSpec, source: MjcfSource, fixed: bool) -> None:
    """Remove the free joints of a fixed base, or add the missing free joints of a floating base."""
    for root in source.roots if fixed or source.base == "fixed" else ():
        for joint in list(child.body(root).joints):
            if joint.type == mujoco.mjtJoint.mjJNT_FREE:
                _drop_users(child, joint.name)
                _shorten_keys(child, joint.name)
                child.delete(joint)
    for name in source.free.values() if source.base == "floating" and not fixed else ():
        if child.joint(name) is None:
            for key in list(child.keys):  # keyframes do not contain the pose of the base
                child.delete(key)
            child.body(name.removesuffix("_free")).add_freejoint(name=name)


def _shorten_keys(child: mujoco.MjSpec, joint: str) -> None:
    """Remove the positions and velocities of a joint from the keyframes."""
    q = v = 0
    for other in child.joints:
        wide = JOINT_WIDTHS.get(int(other.type), (1, 1))
        if other.name == joint:
            break
        q, v = q + wide[0], v + wide[1]
    for key in child.keys:
        if len(key.qpos):
            key.qpos = np.delete(key.qpos, slice(q, q + wide[0]))
        if len(key.qvel):
            key.qvel = np.delete(key.qvel, slice(v, v + wide[1]))


def _drop_users(child: mujoco.MjSpec, joint: str) -> None:
    drives = (mujoco.mjtTrn.mjTRN_JOINT, mujoco.mjtTrn.mjTRN_JOINTINPARENT)
    for actuator in list(child.actuators):
        if actuator.target == joint and actuator.trntype in drives:
            child.delete(actuator)
    for sensor in list(child.sensors):
        if sensor.objname == joint and sensor.objtype == mujoco.mjtObj.mjOBJ_JOINT:
            child.delete(sensor)


def keep_only_model(child: mujoco.MjSpec, source: MjcfSource) -> None:
    """Remove everything from a world's file that does not belong to one model."""
    for body in list(child.worldbody.bodies):
        if body.name not in source.roots:
            child.delete(body)
    own_geoms = set(source.geoms) if WORLD in source.bodies.values() else set()
    for kind, names in (("geoms", own_geoms), ("lights", set()), ("sites", set()), ("cameras", set())):
        for element in list(getattr(child.worldbody, kind)):
            if element.name not in names:
                child.delete(element)
    for key in list(child.keys):
        child.delete(key)
