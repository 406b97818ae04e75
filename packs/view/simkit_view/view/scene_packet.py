"""Packet `scene`: everything that the compiled model draws, and the names that the page shows."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.geom_groups import COLLISION, COLLISION_CONTACT, DRAWN_COLLISION, VISUAL
from simkit.linear_algebra import matmul
from simkit.run_spec import JsonObject
from simkit_view.view.joint_groups import joint_groups
from simkit_view.view.packet import make_packet

if TYPE_CHECKING:
    from simkit import Model, Simulation

_SHOWN: Final = (DRAWN_COLLISION, VISUAL, COLLISION, COLLISION_CONTACT)
_LARGEST_TEXTURE: Final = 1024  # [px]; larger images are reduced, because the page loads them with the scene
_JPEG_QUALITY: Final = 90
_ROLE: Final = int(mujoco.mjtTextureRole.mjTEXROLE_RGB)
_FREE, _BALL = int(mujoco.mjtJoint.mjJNT_FREE), int(mujoco.mjtJoint.mjJNT_BALL)
_UNSET = (0.5, 0.5, 0.5, 1.0)  # colour of a geom that has none of its own
_CLOUD: Final = "sensor_msgs/msg/PointCloud2"
_MESH, _HEIGHTS = int(mujoco.mjtGeom.mjGEOM_MESH), int(mujoco.mjtGeom.mjGEOM_HFIELD)

Packed = dict[str, npt.NDArray[np.generic]]


def make_scene_packet(sim: Simulation, revision: int, extra: JsonObject) -> bytes:
    """Return the packet of the present structure.

    Args:
        sim: simulation to show.
        revision: number of the structure; packets with states name it.
        extra: further values of the head.
    """
    model = sim.mj_model
    arrays: Packed = {}
    head: JsonObject = {
        "kind": "scene",
        "revision": revision,
        "world": sim.world.name,
        "bare": sim.world.where.line is None,  # a model that was loaded without a world
        "timestep": sim.timestep,
        "bodies": [model.body(body).name for body in range(model.nbody)],
        "sensors": [_sensor_dict(sim, sensor) for sensor in sim.contents.sensors.values()],
        "models": [_model_dict(handle) for handle in sim.models.values()],
        **_joints(sim),
        "surroundings": _surroundings(sim),
        "clouds": [topic for topic, type_name in sim.topics().items() if type_name == _CLOUD],
        "frames": _frames(sim),
        **_geoms(sim, arrays),
        **_meshes(model, arrays),
        **_images(model, arrays),
        **_skins(model, arrays),
        **extra,
    }
    arrays |= appearance(sim)
    arrays["moving"] = moving_bodies(model)
    arrays["body_pose"] = poses(sim, np.arange(model.nbody))
    arrays["body_mass"], arrays["body_inertia"] = model.body_mass, model.body_inertia
    arrays["body_ipos"], arrays["body_iquat"] = model.body_ipos, model.body_iquat
    return make_packet(head, arrays)


def moving_bodies(model: mujoco.MjModel) -> npt.NDArray[np.int32]:
    """Return the ids of the bodies that can move, which are those that states contain."""
    is_moving = model.body_weldid != 0
    is_moving |= model.body_mocapid[model.body_rootid] >= 0
    bodies: npt.NDArray[np.int32] = np.flatnonzero(is_moving).astype(np.int32)
    return bodies


def poses(sim: Simulation, bodies: npt.NDArray[np.generic]) -> npt.NDArray[np.float32]:
    """Return position [m] and quaternion (w, x, y, z) of bodies in the world, shape (len(bodies), 7)."""
    data = sim.engine.physics.fresh()  # of the present state, also after a pose was set
    return np.concatenate((data.xpos[bodies], data.xquat[bodies]), axis=1).astype(np.float32)


def appearance(sim: Simulation) -> Packed:
    """Return the arrays that may change without a change of the structure: colours, fixed shapes and lights."""
    model = sim.mj_model
    colours = model.geom_rgba.copy()
    with_material = (model.geom_matid >= 0) & np.all(colours == np.array(_UNSET, np.float32), axis=1)
    colours[with_material] = model.mat_rgba[model.geom_matid[with_material]]
    return {
        "geom_rgba": colours,
        "geom_pos": model.geom_pos,
        "geom_quat": model.geom_quat,
        "light_pos": sim.mj_data.light_xpos,
        "light_dir": sim.mj_data.light_xdir,
        "light_diffuse": model.light_diffuse,
        "light_active": np.asarray(model.light_active, dtype=np.uint8),
    }


# ---------------------------------------------------------------------- drawn shapes


def _geoms(sim: Simulation, arrays: Packed) -> JsonObject:
    model, names = sim.mj_model, sim.engine.names
    shown = np.isin(model.geom_group, _SHOWN)
    arrays["geom_shown"] = shown.astype(np.uint8)
    arrays["geom_type"], arrays["geom_body"] = model.geom_type, model.geom_bodyid
    arrays["geom_group"], arrays["geom_material"] = model.geom_group, model.geom_matid
    arrays["geom_data"], arrays["geom_size"] = model.geom_dataid, model.geom_size
    owners: dict[tuple[str, str], int] = {}
    index = np.full(model.ngeom, -1, np.int32)
    for geom in np.flatnonzero(shown):
        link, scoped, _ = names.geom_owner(int(geom))
        if not link:
            link = model.body(int(model.geom_bodyid[geom])).name
        index[geom] = owners.setdefault((link, scoped), len(owners))
    arrays["geom_owner"] = index
    drawn = {link for (link, _), number in owners.items() if np.any(model.geom_group[index == number] <= VISUAL)}
    return {"owners": [list(owner) for owner in owners], "undrawn": _undrawn_models(sim, drawn)}


def _undrawn_models(sim: Simulation, drawn: set[str]) -> list[str]:
    """Return the moving models without any visual and the links whose meshes are missing.

    Their collisions are drawn instead.
    """
    prefixes = {link.split("::", 1)[0] for link in drawn}
    models = [name for name, model in sim.models.items() if not model.static and name not in prefixes]
    return models + [link.scoped for link in sim.engine.names.links.values() if link.has_missing_visuals]


def _meshes(model: mujoco.MjModel, arrays: Packed) -> JsonObject:
    """Pack the meshes and height fields of the shown geoms."""
    used = set(model.geom_dataid[(model.geom_type == _MESH) & np.isin(model.geom_group, _SHOWN)].tolist())
    for mesh in sorted(used):
        arrays |= _mesh(model, mesh)
    for field in range(model.nhfield):
        rows, columns, begin = model.hfield_nrow[field], model.hfield_ncol[field], model.hfield_adr[field]
        arrays[f"heights{field}"] = model.hfield_data[begin : begin + rows * columns].reshape(rows, columns)
        arrays[f"heights{field}.size"] = model.hfield_size[field]
    shapes = np.stack((model.hfield_nrow, model.hfield_ncol), axis=1).tolist()
    return {"meshes": sorted(used), "heightShapes": shapes}


def _mesh(model: mujoco.MjModel, mesh: int) -> Packed:
    """Return a mesh with one corner for each combination of position, normal and texture coordinate."""
    faces = slice(model.mesh_faceadr[mesh], model.mesh_faceadr[mesh] + model.mesh_facenum[mesh])
    columns = [model.mesh_face[faces].ravel(), model.mesh_facenormal[faces].ravel()]
    has_texture = model.mesh_texcoordadr[mesh] >= 0
    if has_texture:
        columns.append(model.mesh_facetexcoord[faces].ravel())
    corners, indices = np.unique(np.stack(columns, axis=1), axis=0, return_inverse=True)
    name = f"mesh{mesh}"
    packed = {
        f"{name}.position": model.mesh_vert[model.mesh_vertadr[mesh] + corners[:, 0]],
        f"{name}.normal": model.mesh_normal[model.mesh_normaladr[mesh] + corners[:, 1]],
        f"{name}.index": indices.reshape(-1),
    }
    if has_texture:
        packed[f"{name}.uv"] = model.mesh_texcoord[model.mesh_texcoordadr[mesh] + corners[:, 2]]
    return packed


def _images(model: mujoco.MjModel, arrays: Packed) -> JsonObject:
    """Pack materials and textures."""
    materials = []
    for material in range(model.nmat):
        texture = int(model.mat_texid[material][_ROLE])
        values = {name: float(getattr(model, f"mat_{name}")[material]) for name in _MATERIAL}
        repeat = model.mat_texrepeat[material].tolist()
        uniform = bool(model.mat_texuniform[material])
        materials.append({**values, "texture": texture, "repeat": repeat, "uniform": uniform})
    textures = []
    for texture in range(model.ntex):
        kind = int(model.tex_type[texture])
        arrays[f"texture{texture}"] = np.frombuffer(_encode_texture(model, texture), np.uint8)
        textures.append({"kind": ("2d", "cube", "sky")[kind], "name": model.tex(texture).name})
    return {"materials": materials, "textures": textures}


_MATERIAL: Final = ("specular", "shininess", "reflectance", "metallic", "roughness", "emission")


def _encode_texture(model: mujoco.MjModel, texture: int) -> bytes:
    """Return a texture as JPEG, or as PNG if it has transparency; a cube as six squares from top to bottom."""
    import cv2

    height, width, channels = model.tex_height[texture], model.tex_width[texture], model.tex_nchannel[texture]
    begin = model.tex_adr[texture]
    pixels = model.tex_data[begin : begin + height * width * channels].reshape(height, width, channels)
    if channels >= 3:
        pixels = pixels[:, :, [2, 1, 0, 3][:channels]]
    factor = _LARGEST_TEXTURE / max(width, height if int(model.tex_type[texture]) == 0 else width)
    if factor < 1:
        pixels = cv2.resize(np.ascontiguousarray(pixels), None, fx=factor, fy=factor, interpolation=cv2.INTER_AREA)
    suffix, options = (".png", []) if channels in (2, 4) else (".jpg", [cv2.IMWRITE_JPEG_QUALITY, _JPEG_QUALITY])
    return bytes(cv2.imencode(suffix, np.ascontiguousarray(pixels), options)[1])


def _skins(model: mujoco.MjModel, arrays: Packed) -> JsonObject:
    """Pack skins: their vertices at rest, and the bones that move them."""
    skins = []
    for skin in range(model.nskin):
        vertices = _range(model.skin_vertadr, model.skin_vertnum, skin)
        faces = _range(model.skin_faceadr, model.skin_facenum, skin)
        bones = _range(model.skin_boneadr, model.skin_bonenum, skin)
        name = f"skin{skin}"
        arrays[f"{name}.position"] = model.skin_vert[vertices]
        arrays[f"{name}.index"] = model.skin_face[faces]
        if model.skin_texcoordadr[skin] >= 0:
            begin = model.skin_texcoordadr[skin]
            arrays[f"{name}.uv"] = model.skin_texcoord[begin : begin + model.skin_vertnum[skin]]
        arrays[f"{name}.bone_body"] = model.skin_bonebodyid[bones]
        arrays[f"{name}.bone_pos"] = model.skin_bonebindpos[bones]
        arrays[f"{name}.bone_quat"] = model.skin_bonebindquat[bones]
        arrays[f"{name}.bone_count"] = model.skin_bonevertnum[bones]
        begins, counts = model.skin_bonevertadr[bones], model.skin_bonevertnum[bones]
        rows = [np.arange(b, b + n) for b, n in zip(begins, counts, strict=True)]
        order = np.concatenate(rows) if rows else np.zeros(0, int)
        arrays[f"{name}.vertex"] = model.skin_bonevertid[order]
        arrays[f"{name}.weight"] = model.skin_bonevertweight[order]
        rgba = model.skin_rgba[skin].tolist()
        skins.append({"material": int(model.skin_matid[skin]), "rgba": rgba, "group": int(model.skin_group[skin])})
    return {"skins": skins}


def _range(begins: npt.NDArray[np.generic], counts: npt.NDArray[np.generic], number: int) -> slice:
    return slice(begins[number], begins[number] + counts[number])


# ---------------------------------------------------------------------- names


def _model_dict(model: Model) -> JsonObject:
    """Return a model with its links and nested models."""
    return {
        "name": model.name,
        "scoped": model.scoped,
        "static": model.static,
        "links": [link.scoped for link in model.links.values()],
        "models": [_model_dict(inner) for inner in model.models.values()],
    }


def _sensor_dict(sim: Simulation, sensor: Any) -> JsonObject:
    """Return a sensor with its body, and its pose in the frame of the body."""
    link = sim.engine.names.links.get(sensor.scene.parent)
    body = link.body if link is not None else 0
    data = sim.mj_data
    rotation, origin = data.xmat[body].reshape(3, 3), data.xpos[body]
    pose, turned = sensor.pose, np.empty(4)
    mujoco.mju_mat2Quat(turned, matmul(rotation.T, pose.matrix).ravel())
    place = [*matmul(rotation.T, pose.position - origin).tolist(), *turned.tolist()]
    return {
        "name": sensor.scoped,
        "kind": sensor.kind,
        "topic": sensor.topic,
        "rate": sensor.update_rate,
        "body": int(body),
        "pose": place,
        "link": sensor.scene.parent,
        **sensor.describe(),
    }


def _frames(sim: Simulation) -> list[list[object]]:
    """Return the frame of each link: scoped name, body, and pose in the frame of the body."""
    frames = []
    for scoped, link in sim.engine.names.links.items():
        offset = [*link.offset.position.tolist(), *link.offset.quaternion.tolist()]
        frames.append([scoped, int(link.body), offset])
    return frames


def _joints(sim: Simulation) -> JsonObject:
    """Return the joints that move, with type, limits, and their axis in MuJoCo's model; and their groups."""
    joints, model = [], sim.mj_model
    moving = {scoped: joint for scoped, joint in sim.contents.handles.tables["joint"].items() if joint.dof >= 1}
    for scoped, joint in moving.items():
        axes = [int(model.dof_jntid[dof]) for dof in joint.mj_dofs if model.jnt_type[model.dof_jntid[dof]] > _BALL]
        lower, upper = (_finite(value) for value in (joint.lower, joint.upper)) if joint.dof == 1 else (None, None)
        place = [[int(model.jnt_bodyid[a]), model.jnt_pos[a].tolist(), model.jnt_axis[a].tolist()] for a in axes]
        joints.append({"name": scoped, "type": joint.type, "lower": lower, "upper": upper, "axes": place})
    return {"joints": joints, "jointGroups": joint_groups(sim, list(moving.values()))}


def _finite(value: float) -> float | None:
    """Return a limit; None for a joint without this limit."""
    number = float(value)
    return number if math.isfinite(number) and abs(number) < 1e15 else None


def _surroundings(sim: Simulation) -> JsonObject:
    """Return sky, background, fog and lights."""
    model, around = sim.mj_model, sim.world.surroundings
    lights = [
        {
            "kind": ("spot", "directional", "point", "image")[int(model.light_type[light])],
            "shadow": bool(model.light_castshadow[light]),
            "cutoff": float(model.light_cutoff[light]),
            "exponent": float(model.light_exponent[light]),
            "attenuation": model.light_attenuation[light].tolist(),
            "ambient": model.light_ambient[light].tolist(),
        }
        for light in range(model.nlight)
    ]
    fog = getattr(around, "fog", None)
    return {
        "lights": lights,
        "ambient": (np.asarray(model.vis.headlight.ambient)).tolist(),
        "headlight": (np.asarray(model.vis.headlight.diffuse)).tolist(),
        "background": list(around.background[:3]),
        "sky": bool(around.sky),
        "grid": bool(around.grid),
        "shadows": bool(around.shadows),
        "fog": None if fog is None else {name: _plain(getattr(fog, name)) for name in fog.__dataclass_fields__},
        "extent": float(model.stat.extent),
    }


def _plain(value: object) -> object:
    return list(value) if isinstance(value, tuple) else value
