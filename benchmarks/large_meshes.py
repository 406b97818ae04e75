"""Worlds of large static meshes, made of formulas, for the measurements of loads and steps."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
import trimesh

Mesh = trimesh.Trimesh
Floats = npt.NDArray[np.float64]


def grid_faces(rows: int, columns: int) -> npt.NDArray[np.int64]:
    """Return the triangles between rows of points, each one point longer than its number of cells."""
    i, j = (index.ravel() for index in np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij"))
    a = i * (columns + 1) + j
    b = a + columns + 1
    return np.vstack([np.column_stack([a, b, b + 1]), np.column_stack([a, b + 1, a + 1])])


def terrain(cells: int = 212, phase: float = 0.0) -> Mesh:
    """Return hills over 60 m × 60 m in a regular grid."""
    at = np.linspace(-30.0, 30.0, cells + 1)
    x, y = np.meshgrid(at, at, indexing="ij")
    z = np.sin(0.3 * x + phase) * np.cos(0.2 * y) + 0.3 * np.sin(x + 0.7 * y)
    return Mesh(np.stack([x, y, z], axis=-1).reshape(-1, 3), grid_faces(cells, cells), process=False)


def rough_ground(seed: int, cells: int = 70) -> Mesh:
    """Return bumps over 10 m × 10 m whose points form no regular grid."""
    x, y = np.meshgrid(*(np.linspace(0.0, 10.0, cells + 1),) * 2, indexing="ij")
    shift = np.random.default_rng(seed).uniform(-0.04, 0.04, (2, *x.shape))
    x, y = x + shift[0], y + shift[1]
    z = 0.5 * np.sin(x) * np.cos(0.7 * y) + 0.1 * np.sin(3.0 * x + y)
    return Mesh(np.stack([x, y, z], axis=-1).reshape(-1, 3), grid_faces(cells, cells), process=False)


def knot(sections: int, sides: int, turns: tuple[int, int] = (2, 3), radius: float = 0.8) -> Mesh:
    """Return a closed pipe along a torus knot of 17 m."""
    around, across = turns

    def middle(t: Floats) -> Floats:
        distance = 6.0 + 2.0 * np.cos(across * t)
        return np.column_stack([distance * np.cos(around * t), distance * np.sin(around * t), 2.0 * np.sin(across * t)])

    turn = np.linspace(0.0, 2.0 * np.pi, sections, endpoint=False)
    centre, along = middle(turn), middle(turn + 1e-4) - middle(turn - 1e-4)
    first = np.cross(along, (0.0, 0.0, 1.0))
    second = np.cross(along, first)
    first, second = (axis / np.linalg.norm(axis, axis=1)[:, None] for axis in (first, second))
    angle = np.linspace(0.0, 2.0 * np.pi, sides, endpoint=False)[None, :, None]
    points = centre[:, None] + radius * (np.cos(angle) * first[:, None] + np.sin(angle) * second[:, None])
    i, j = (index.ravel() for index in np.meshgrid(np.arange(sections), np.arange(sides), indexing="ij"))
    after_i, after_j = (i + 1) % sections, (j + 1) % sides
    a, b, c, d = i * sides + j, after_i * sides + j, after_i * sides + after_j, i * sides + after_j
    mesh = Mesh(points.reshape(-1, 3), np.vstack([np.column_stack([a, b, c]), np.column_stack([a, c, d])]))
    if mesh.volume < 0.0:
        mesh.invert()
    return mesh


def rock(seed: int, divisions: int) -> Mesh:
    """Return a closed lumpy body of 6 m."""
    ball, rng = trimesh.creation.icosphere(subdivisions=divisions, radius=3.0), np.random.default_rng(seed)
    waves = [(rng.normal(), rng.normal(size=3), rng.uniform(0.0, 6.0)) for _ in range(8)]
    lumps = sum(height * np.sin(1.5 * ball.vertices @ along + start) for height, along, start in waves)
    return Mesh(ball.vertices * (1.0 + 0.06 * np.asarray(lumps)[:, None]), ball.faces, process=False)


def tori(count: int) -> Mesh:
    """Return separate rings of 300 triangles."""
    rings = [trimesh.creation.torus(0.5, 0.15, major_sections=15, minor_sections=10) for _ in range(count)]
    for k, ring in enumerate(rings):
        ring.apply_translation((2.0 * (k % 20), 2.0 * (k // 20), 0.3 * (k % 3)))
    return trimesh.util.concatenate(rings)


def walls(count: int, triangles: int) -> Mesh:
    """Return walls with doors, divided until they have a number of triangles."""
    door = [((0.0, 0.0), (1.5, 2.5)), ((2.5, 0.0), (4.0, 2.5)), ((1.5, 2.0), (2.5, 2.5))]
    parts = []
    for k in range(count):
        for (x, z), (end, top) in door:
            box = trimesh.creation.box(bounds=((x, 0.0, z), (end, 0.2, top)))
            if k % 2:
                box.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, (0, 0, 1)))
            parts.append(box.apply_translation((4.0 * (k % 7), 4.0 * (k // 7), 0.0)))
    mesh = trimesh.util.concatenate(parts)
    mesh.merge_vertices()
    while len(mesh.faces) < triangles:
        mesh = mesh.subdivide()
    return mesh


def mixed() -> list[Mesh]:
    """Return ten different meshes of 4000 to 20,000 triangles, of 10,000 on average."""
    apart = [rock(6, 3), rock(7, 4).apply_translation((9.0, 0.0, 0.0)), rough_ground(8, 50)]
    bodies = [knot(250, 20), knot(200, 25, (3, 2), 0.5), rock(1, 4), rock(2, 5), rough_ground(3), rough_ground(4)]
    ring = trimesh.creation.torus(3.0, 1.0, major_sections=100, minor_sections=50)
    return [*bodies, tori(33), walls(40, 5000), ring, trimesh.util.concatenate(apart)]


def write_world(folder: Path, meshes: list[Mesh], scales: list[float] | None = None) -> Path:
    """Write a world of static meshes, and a ball far above them, and return its path.

    Args:
        folder: folder of the files.
        meshes: meshes of the models; models of the same mesh share one file.
        scales: scale of each model; None for 1.
    """
    folder.mkdir(parents=True)
    models = []
    for k, mesh in enumerate(meshes):
        file = folder / f"mesh{next(n for n, other in enumerate(meshes) if other is mesh)}.stl"
        if not file.is_file():
            mesh.export(file)
        size = 1.0 if scales is None else scales[k]
        shape = f"<geometry><mesh><uri>{file.name}</uri><scale>{size} {size} {size}</scale></mesh></geometry>"
        pose = f"<pose>{80 * (k % 4)} {80 * (k // 4)} 0 0 0 0</pose>"
        models.append(
            f'<model name="m{k}">{pose}<static>true</static><link name="l">'
            f'<collision name="c">{shape}</collision><visual name="v">{shape}</visual></link></model>'
        )
    world = folder / "world.sdf"
    world.write_text(f'<sdf version="1.9"><world name="w">{"".join(models)}{BALL}</world></sdf>')
    return world


BALL = (
    '<model name="ball"><pose>0 0 1000 0 0 0</pose><link name="l"><inertial auto="true"/><collision name="c">'
    "<geometry><sphere><radius>0.1</radius></sphere></geometry></collision></link></model>"
)


def write_worlds(folder: Path) -> dict[str, Path]:
    """Write all worlds and return their paths by their titles."""
    pipe = knot(250, 20)
    return {
        "a ball alone": write_world(folder / "empty", []),
        "terrain of 90,000 triangles": write_world(folder / "terrain", [terrain()]),
        "ten different terrains of 10,000": write_world(folder / "terrains", [terrain(70, 0.1 * k) for k in range(10)]),
        "torus knot of 90,000": write_world(folder / "knot", [knot(1500, 30)]),
        "120 walls with doors in 90,000": write_world(folder / "walls", [walls(120, 69_000)]),
        "ten different meshes of 10,000 on average": write_world(folder / "mixed", mixed()),
        "ten times one pipe of 10,000, in three scales": write_world(
            folder / "scales", [pipe] * 10, [1, 1, 1, 1, 2, 2, 2, 0.5, 0.5, 0.5]
        ),
        "300 tori of 300 triangles in one mesh": write_world(folder / "tori", [tori(300)]),
    }
