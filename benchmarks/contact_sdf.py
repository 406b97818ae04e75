"""The SDF world of a case, and its mesh files."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import numpy.typing as npt
from contact_scene import GROUND, LATERAL, Body, Case, Hinge, Shape, Vector

SLAB = (6.0, 2.0, 0.1)  # half lengths of the ground as a mesh and as a height map [m]
CELLS = 32  # triangles' edges along the slab's top, along each axis
FACETS = 64  # of a wheel as a mesh
MECHANISM = "mechanism"  # name of the model of all bodies at hinges

Vertices = npt.NDArray[np.float64]
Faces = npt.NDArray[np.int64]


def mesh(shape: Shape) -> tuple[Vertices, Faces]:
    """Vertices and triangles of a shape that is given as a mesh."""
    import trimesh

    if shape.kind == "mesh_box":
        made = trimesh.creation.box(extents=[2 * half for half in shape.size])
    else:
        made = trimesh.creation.cylinder(radius=shape.size[0], height=2 * shape.size[1], sections=FACETS)
    return np.asarray(made.vertices), np.asarray(made.faces, dtype=np.int64)


def slab() -> tuple[Vertices, Faces]:
    """The ground as a closed mesh with many triangles in its level top, which is at z = 0."""
    import trimesh

    long, wide, half = SLAB
    made = trimesh.creation.box(extents=[2 * long, 2 * wide, 2 * half])
    for _ in range(int(math.log2(CELLS))):
        made = made.subdivide()
    return np.asarray(made.vertices) - (0.0, 0.0, half), np.asarray(made.faces, dtype=np.int64)


def _write_mesh(vertices: Vertices, faces: Faces, path: Path) -> str:
    lines = [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in vertices.tolist()]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces.tolist()]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path.name


def _words(numbers: object) -> str:
    return " ".join(f"{number:.12g}" for number in np.ravel(numbers))  # type: ignore[call-overload]


def _sdf_geometry(shape: Shape, folder: Path) -> str:
    size = shape.size
    if shape.kind == "box":
        inner = f"<size>{_words(np.multiply(2, size))}</size>"
    elif shape.kind == "ellipsoid":
        inner = f"<radii>{_words(size)}</radii>"
    elif shape.kind == "sphere":
        inner = f"<radius>{size[0]}</radius>"
    elif shape.kind in {"cylinder", "capsule"}:
        inner = f"<radius>{size[0]}</radius><length>{2 * size[1]}</length>"
    else:
        name = _write_mesh(*mesh(shape), folder / f"{shape.kind}.obj")
        return f"<geometry><mesh><uri>{name}</uri></mesh></geometry>"
    return f"<geometry><{shape.kind}>{inner}</{shape.kind}></geometry>"


def _sdf_surface(mu: float, restitution: float | None) -> str:
    bounce = f"<restitution_coefficient>{restitution}</restitution_coefficient><threshold>0</threshold>"
    bounces = f"<bounce>{bounce}</bounce>" if restitution is not None else ""
    return f"<surface><friction><ode><mu>{mu}</mu><mu2>{mu}</mu2></ode></friction>{bounces}</surface>"


def _sdf_link(body: Body, pose: Vector, rpy: Vector, restitution: float | None, folder: Path) -> str:
    x, y, z = body.inertia
    inertia = f"<inertia><ixx>{x:.12g}</ixx><iyy>{y:.12g}</iyy><izz>{z:.12g}</izz></inertia>"
    collision = _sdf_geometry(body.shape, folder) + _sdf_surface(body.mu, restitution)
    touching = f'<collision name="c">{collision}</collision>' if body.touches else ""
    return f"""<link name="{body.name}"><pose>{_words((*pose, *rpy))}</pose>
      <inertial><mass>{body.mass}</mass>{inertia}</inertial>{touching}</link>"""


def _sdf_ground(case: Case, folder: Path) -> str:
    if case.ground == "none":
        return ""
    if case.ground == "mesh":
        shape = f"<mesh><uri>{_write_mesh(*slab(), folder / 'slab.obj')}</uri></mesh>"
    elif case.ground == "heightmap":
        from PIL import Image

        Image.fromarray(np.zeros((CELLS + 1, CELLS + 1), np.uint8)).save(folder / "level.png")
        shape = f"<heightmap><uri>level.png</uri><size>{2 * SLAB[0]} {2 * SLAB[0]} 1</size></heightmap>"
    else:
        shape = "<plane><normal>0 0 1</normal></plane>"
    surface = _sdf_surface(case.ground_mu, case.restitution)
    return f"""<model name="{GROUND}"><static>true</static><link name="link">
      <collision name="c"><geometry>{shape}</geometry>{surface}</collision></link></model>"""


def _sdf_vehicle(case: Case, folder: Path) -> str:
    vehicle = case.vehicle
    assert vehicle is not None
    parts = [_sdf_link(vehicle.chassis, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), None, folder)]
    for name, (x, y) in vehicle.wheels.items():
        wheel = Body(name, vehicle.wheel, vehicle.wheel_mass, (x, y, 0.0), mu=vehicle.mu)
        parts.append(_sdf_link(wheel, wheel.position, LATERAL, None, folder))
        axis = '<axis><xyz expressed_in="__model__">0 1 0</xyz></axis>'
        joint = f"<parent>chassis</parent><child>{name}</child>{axis}"
        parts.append(f'<joint name="{name}_joint" type="revolute">{joint}</joint>')
    joints = "".join(
        f"<{side}_joint>wheel_{number}_joint</{side}_joint>"
        for number, side in enumerate(("left", "right", "left", "right"))
    )
    drive = f"{joints}<wheel_separation>{vehicle.track}</wheel_separation><wheel_radius>{vehicle.radius}</wheel_radius>"
    plugin = f'<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">{drive}</plugin>'
    return f'<model name="vehicle"><pose>0 0 {vehicle.radius} 0 0 0</pose>{"".join(parts)}{plugin}</model>'


def _sdf_model(body: Body, link: str, static: str = "") -> str:
    return f'<model name="{body.name}">{static}<pose>{_words((*body.position, *body.rpy))}</pose>{link}</model>'


def _sdf_hinge(hinge: Hinge) -> str:
    """The joint, whose pose is given in the model's frame, which is the world's."""
    pose = f'<pose relative_to="__model__">{_words((*hinge.anchor, 0, 0, 0))}</pose>'
    ends = f"<parent>{hinge.parent or 'world'}</parent><child>{hinge.child}</child>"
    axis = f'<axis><xyz expressed_in="__model__">{_words(hinge.axis)}</xyz></axis>'
    return f'<joint name="{hinge.child}_joint" type="revolute">{pose}{ends}{axis}</joint>'


def _sdf_mechanism(case: Case, folder: Path) -> str:
    """One model with every body at a hinge."""
    links = "".join(_sdf_link(body, body.position, body.rpy, case.restitution, folder) for body in case.hinged)
    return f'<model name="{MECHANISM}">{links}{"".join(_sdf_hinge(hinge) for hinge in case.hinges)}</model>'


def sdf(case: Case, folder: Path) -> str:
    """The case as an SDF world; its meshes and pictures are written into `folder`."""
    zero = (0.0, 0.0, 0.0)
    parts = [_sdf_ground(case, folder)]
    if case.vehicle:
        parts.append(_sdf_vehicle(case, folder))
    if case.hinges:
        parts.append(_sdf_mechanism(case, folder))
    for body in case.bodies:
        if body not in case.hinged:
            parts.append(_sdf_model(body, _sdf_link(body, zero, zero, case.restitution, folder)))
    for body in case.blocks:
        link = _sdf_link(body, zero, zero, case.restitution, folder)
        parts.append(_sdf_model(body, link, "<static>true</static>"))
    return f"""<sdf version="1.9"><world name="contact"><gravity>0 0 {-case.gravity}</gravity>
      <physics type="ignored"><max_step_size>{case.timestep:.12g}</max_step_size></physics>
      {"".join(parts)}</world></sdf>"""
