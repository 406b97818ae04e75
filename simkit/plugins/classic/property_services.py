"""Properties of models, joints, links and lights for Gazebo Classic's services."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.number_text import counted
from simkit.plugins.world.service_entities import RequestRefused, colour_of, find_entity, pose_fields, require_finite
from simkit.pose import Pose

if TYPE_CHECKING:
    from simkit import msgs
    from simkit.runtime import Joint, Simulation

_TYPES: Final = {"revolute": 0, "continuous": 1, "prismatic": 2, "fixed": 3, "ball": 4, "universal": 5}
_STOPS: Final = {"hi_stop": "upper", "lo_stop": "lower"}
_OF_ODE: Final = ("erp", "cfm", "stop_erp", "stop_cfm", "fudge_factor", "fmax", "vel")


def model_properties(sim: Simulation, request: msgs.GetModelProperties_Request) -> dict[str, object]:
    """Return the response of `GetModelProperties`."""
    scoped = find_entity(sim, request.model_name, ("model",))[1]
    scene = sim.model(scoped).scene
    return {
        "parent_model_name": scoped.rpartition("::")[0],
        "canonical_body_name": scene.canonical_link,
        "body_names": [link.scoped for link in scene.links],
        "geom_names": [collision.name for link in scene.links for collision in link.collisions],
        "joint_names": [joint.name for joint in scene.joints],
        "child_model_names": [model.name for model in scene.models],
        "is_static": scene.static,
        "status_message": "GetModelProperties: got properties",
    }


def joint_properties(sim: Simulation, request: msgs.GetJointProperties_Request) -> dict[str, object]:
    """Return the response of `GetJointProperties`."""
    joint = joint_of(sim, request.joint_name)
    if joint.type not in _TYPES:
        message = f"GetJointProperties: got properties; the message has no type for a {joint.type} joint, so type is 0"
    else:
        message = "GetJointProperties: got properties"
    return {
        "type": _TYPES.get(joint.type, 0),
        "damping": sim.mj_model.dof_damping[list(joint.mj_dofs)].tolist(),
        "position": np.atleast_1d(joint.position).tolist(),
        "rate": np.atleast_1d(joint.velocity).tolist(),
        "status_message": message,
    }


def set_joint_properties(sim: Simulation, request: msgs.SetJointProperties_Request) -> str:
    """Set damping and position limits; return a message that lists the ignored parameters of ODE.

    Raises:
        RequestRefused: the joint does not exist, or a number is not valid for this joint.
    """
    joint, config = joint_of(sim, request.joint_name), request.ode_joint_config
    dofs = list(joint.mj_dofs)
    damping = [require_finite(value, "damping", 0.0) for value in config.damping]
    stops = {name: [require_finite(value, name) for value in getattr(config, name)] for name in _STOPS}
    for name, values in {"damping": damping, **stops}.items():
        if len(values) > len(dofs):
            count = f"{len(dofs)} degrees of freedom"
            raise RequestRefused(
                f"found {counted(len(values), 'number')} in {name}; joint {joint.scoped!r} has {count}"
            )
    if any(stops.values()) and len(dofs) != 1:
        raise RequestRefused(f"joint {joint.scoped!r} has {len(dofs)} degrees of freedom; limits need exactly one")
    if damping:
        sim.engine.touch("dof_damping")[dofs[: len(damping)]] = damping
    for name, values in stops.items():
        if values:
            setattr(joint, _STOPS[name], values[0])
    unused = [name for name in _OF_ODE if len(getattr(config, name))]
    return "SetJointProperties: properties set" + (f"; not used: {', '.join(unused)}" if unused else "")


def link_properties(sim: Simulation, request: msgs.GetLinkProperties_Request) -> dict[str, object]:
    """Return the response of `GetLinkProperties`."""
    scene = sim.link(find_entity(sim, request.link_name, ("link",))[1]).scene
    moments = dict(zip(("ixx", "iyy", "izz", "ixy", "ixz", "iyz"), scene.inertial.inertia, strict=True))
    return {
        "com": pose_fields(Pose(scene.inertial.com)),
        "gravity_mode": scene.gravity,
        "mass": scene.inertial.mass,
        **moments,
        "status_message": "GetLinkProperties: got properties",
    }


def light_properties(sim: Simulation, request: msgs.GetLightProperties_Request) -> dict[str, object]:
    """Return the response of `GetLightProperties`."""
    scene = sim.light(find_entity(sim, request.light_name, ("light",))[1]).scene
    _, constant, linear, quadratic = scene.attenuation
    return {
        "diffuse": dict(zip("rgba", scene.diffuse, strict=True)),
        "attenuation_constant": constant,
        "attenuation_linear": linear,
        "attenuation_quadratic": quadratic,
    }


def set_light_properties(sim: Simulation, request: msgs.SetLightProperties_Request) -> None:
    """Set diffuse colour and attenuation of a light."""
    light = sim.light(find_entity(sim, request.light_name, ("light",))[1])
    names = ("attenuation_constant", "attenuation_linear", "attenuation_quadratic")
    constant, linear, quadratic = (require_finite(getattr(request, name), name, 0.0) for name in names)
    diffuse = colour_of(request.diffuse, "diffuse") or (0.0, 0.0, 0.0, 0.0)
    fading = (light.scene.attenuation[0], constant, linear, quadratic)
    light.change(replace(light.scene, diffuse=diffuse, attenuation=fading))


def joint_of(sim: Simulation, name: str) -> Joint:
    """Return the joint with a scoped name, else the first joint with this plain name; raises `RequestRefused`."""
    return sim.joint(find_entity(sim, name, ("joint",))[1])
