"""The text of a case's model for each engine: SDF for simkit, MJCF for plain MuJoCo, and the mesh files of both."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import numpy.typing as npt
from contact_cases import GRAVITY, GROUND, LATERAL, Body, Case, Shape, Vector
from scipy.optimize import brentq

SLAB = (6.0, 2.0, 0.1)  # half lengths of the ground as a mesh and as a height map [m]
CELLS = 32  # triangles' edges along the slab's top, along each axis
FACETS = 64  # of a wheel as a mesh
DRIVE = 50.0  # gain of the wheels' drives in plain MuJoCo [N·m·s/rad]; 200 throws the vehicle 0.2 m up
OMEGA = 50 * math.pi  # of the spring of a contact that bounces, in plain MuJoCo [rad/s]

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


# SDF


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
    x, y, z = np.multiply(body.mass, body.shape.inertia).tolist()
    inertia = f"<inertia><ixx>{x:.12g}</ixx><iyy>{y:.12g}</iyy><izz>{z:.12g}</izz></inertia>"
    collision = _sdf_geometry(body.shape, folder) + _sdf_surface(body.mu, restitution)
    return f"""<link name="{body.name}"><pose>{_words((*pose, *rpy))}</pose>
      <inertial><mass>{body.mass}</mass>{inertia}</inertial><collision name="c">{collision}</collision></link>"""


def _sdf_ground(case: Case, folder: Path) -> str:
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


def sdf(case: Case, folder: Path) -> str:
    """The case as an SDF world; its meshes and pictures are written into `folder`."""
    if case.vehicle:
        models = _sdf_vehicle(case, folder)
    else:
        links = ((body, _sdf_link(body, (0, 0, 0), (0, 0, 0), case.restitution, folder)) for body in case.bodies)
        models = "".join(
            f'<model name="{body.name}"><pose>{_words((*body.position, *body.rpy))}</pose>{link}</model>'
            for body, link in links
        )
    return f"""<sdf version="1.9"><world name="contact"><gravity>0 0 {-GRAVITY}</gravity>
      <physics type="ignored"><max_step_size>{case.timestep}</max_step_size></physics>
      {_sdf_ground(case, folder)}{models}</world></sdf>"""


# MJCF


def _mjcf_surface(case: Case, mu: float) -> str:
    """Friction with the priority that makes the smaller coefficient of two count, and the spring of a rebound."""
    lower = sorted({case.ground_mu, *(body.mu for body in case.moving)}, reverse=True)
    text = f'friction="{mu} 0.005 0.0001" priority="{lower.index(mu)}"'
    if not mu:
        text += ' condim="1"'  # a pyramid of no width keeps the solver from converging
    if case.restitution is None:
        return text
    return f'{text} solref="{-(OMEGA**2)} {-2 * OMEGA * _damping_ratio(case.restitution)}"'


def _damping_ratio(restitution: float) -> float:
    """Find the damping ratio of a spring that only pushes and sends a body back at `restitution` times its speed.

    It lets go after an angle of pi - atan2(2 z s, 1 - 2 z²), s = sqrt(1 - z²) (Schwager and Pöschel 2007).
    """

    def excess(z: float) -> float:
        s = math.sqrt(1 - z * z)
        return math.exp(-z / s * (math.pi - math.atan2(2 * z * s, 1 - 2 * z * z))) - restitution

    return float(brentq(excess, 0.0, 0.999))


def _mjcf_body(case: Case, body: Body, joint: str) -> str:
    kind, size = body.shape.kind, body.shape.size
    shape = f'type="mesh" mesh="{body.name}"' if kind.startswith("mesh") else f'type="{kind}" size="{_words(size)}"'
    inertia = _words(np.multiply(body.mass, body.shape.inertia))
    return f"""<body name="{body.name}" pos="{_words(body.position)}" euler="{_words(body.rpy)}">{joint}
      <inertial pos="0 0 0" mass="{body.mass}" diaginertia="{inertia}"/>
      <geom {shape} {_mjcf_surface(case, body.mu)}/>"""


def _mjcf_vehicle(case: Case) -> tuple[str, str]:
    """The bodies and the drives: a motor against a damper, which the default integrator treats implicitly."""
    vehicle = case.vehicle
    assert vehicle is not None
    wheels, drives = [], []
    for name, (x, y) in vehicle.wheels.items():
        wheel = Body(name, vehicle.wheel, vehicle.wheel_mass, (x, y, 0.0), LATERAL, vehicle.mu)
        joint = f'<joint name="{name}" axis="0 0 -1" damping="{DRIVE}"/>'  # the wheel's -z is the vehicle's y
        wheels.append(_mjcf_body(case, wheel, joint) + "</body>")
        drives.append(f'<motor joint="{name}" gear="{DRIVE}"/>')
    body = _mjcf_body(case, vehicle.chassis, "<freejoint/>") + "".join(wheels) + "</body>"
    return body, f"<actuator>{''.join(drives)}</actuator>"


def mjcf(case: Case) -> str:
    """The case as MJCF with MuJoCo's default options."""
    surface = _mjcf_surface(case, case.ground_mu)
    assets = []
    if case.ground == "mesh":
        vertices, faces = slab()
        assets.append(f'<mesh name="slab" vertex="{_words(vertices)}" face="{_words(faces)}"/>')
        ground = f'<geom type="mesh" mesh="slab" {surface}/>'
    elif case.ground == "heightmap":
        size = f"{SLAB[0]} {SLAB[0]} 1 1"
        assets.append(f'<hfield name="level" nrow="{CELLS + 1}" ncol="{CELLS + 1}" size="{size}"/>')
        ground = f'<geom type="hfield" hfield="level" {surface}/>'
    else:
        ground = f'<geom type="plane" size="1 1 1" {surface}/>'
    shapes = {body.name: body.shape for body in case.bodies}
    if case.vehicle:
        bodies, drives = _mjcf_vehicle(case)
        shapes |= dict.fromkeys(case.vehicle.wheels, case.vehicle.wheel)
    else:
        bodies = "".join(_mjcf_body(case, body, "<freejoint/>") + "</body>" for body in case.bodies)
        drives = ""
    for name, shape in shapes.items():
        if shape.kind.startswith("mesh"):
            vertices, faces = mesh(shape)
            assets.append(f'<mesh name="{name}" vertex="{_words(vertices)}" face="{_words(faces)}"/>')
    return f"""<mujoco><compiler angle="radian" eulerseq="XYZ"/>
      <option timestep="{case.timestep}" gravity="0 0 {-GRAVITY}"/>
      <asset>{"".join(assets)}</asset><worldbody>{ground}{bodies}</worldbody>{drives}</mujoco>"""
