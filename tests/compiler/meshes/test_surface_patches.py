"""Large static meshes collide as patches: few pieces that keep holes, layers and slopes."""

from __future__ import annotations

from pathlib import Path

import mujoco
import numpy as np
import pytest
import trimesh

import simkit
from simkit.compiler.meshes.convex_decomposition import convex_bodies
from simkit.compiler.meshes.surface_patches import is_large, large_surface_pieces
from simkit.pose import Pose
from simkit.scene import Box, Mesh, Sphere

ROBOT = Path(__file__).parents[3] / "assets/turtlebot3/turtlebot3_burger"


def grid(heights, step, keep=None):
    """Return vertices and faces of a ground with these heights; `keep` is a mask of its cells."""
    rows, columns = heights.shape
    x, y = np.meshgrid(np.arange(rows) * step, np.arange(columns) * step, indexing="ij")
    vertices = np.stack([x, y, heights], axis=-1).reshape(-1, 3)
    i, j = np.nonzero(np.ones((rows - 1, columns - 1), bool) if keep is None else keep)
    a = i * columns + j
    lower = np.column_stack([a, a + columns, a + columns + 1])
    return vertices, np.vstack([lower, np.column_stack([a, a + columns + 1, a + 1])]).astype(np.int32)


def tile_surface(tile):
    """Return the upper surface of a height field as a mesh."""
    rows, columns = tile.heights.shape
    x, y = np.meshgrid(np.arange(columns) * tile.cell[0], np.arange(rows) * tile.cell[1])
    local = np.stack([x, y, tile.heights], axis=-1).reshape(-1, 3)
    _, faces = grid(tile.heights.T, 1.0)
    order = np.arange(rows * columns).reshape(rows, columns).T.reshape(-1)
    return trimesh.Trimesh(tile.origin + local @ tile.axes.T, order[faces], process=False)


def hills(x, y):
    return 0.3 * np.sin(0.9 * x) * np.sin(1.1 * y)


@pytest.fixture
def ground():
    """6 m × 6 m of hills in 1800 triangles."""
    x, y = np.meshgrid(np.linspace(0, 6, 31), np.linspace(0, 6, 31), indexing="ij")
    return grid(hills(x, y), 0.2)


def settle(make, compiled, tmp_path, mesh, *bodies, steps=1500):
    """Return the data of a world with a static mesh and moving bodies after some milliseconds."""
    trimesh.Trimesh(*mesh, process=False).export(tmp_path / "mesh.stl")
    shape = Mesh(tmp_path / "mesh.stl", "mesh.stl")
    c = compiled(make.model("mesh", make.link("mesh::link", shape), static=True), *bodies)
    mujoco.mj_step(c.model, c.data, steps)
    return c


def test_hills_become_few_bodies_within_their_error(ground):
    vertices, faces = ground
    pieces, tiles, error, _ = large_surface_pieces(vertices, faces)
    assert len(pieces) + len(tiles) < 0.2 * len(faces)
    assert error <= 0.006  # 0.001 of the size of 6 m, from which no patch is cut any more
    hulls = [trimesh.convex.convex_hull(p.points) for p in pieces]
    whole = trimesh.util.concatenate([*hulls, *(tile_surface(tile) for tile in tiles)])
    at = np.random.default_rng(0).uniform(0.2, 5.8, (400, 2))
    down = np.tile([0.0, 0.0, -1.0], (400, 1))
    start = np.column_stack([at, np.full(400, 5.0)])
    tops, rays, _ = whole.ray.intersects_location(start, down, multiple_hits=False)
    true, _, _ = trimesh.Trimesh(vertices, faces).ray.intersects_location(start, down, multiple_hits=False)
    assert len(rays) == 400
    assert np.abs(tops[:, 2] - true[:, 2]).max() < 1.1 * error


def test_a_mesh_gives_the_same_pieces_every_time():
    x, y = np.meshgrid(np.linspace(0, 4, 11), np.linspace(0, 4, 11), indexing="ij")
    first, second = (large_surface_pieces(*grid(hills(x, y), 0.4)) for _ in range(2))
    assert [p.points.tobytes() for p in first.pieces] == [p.points.tobytes() for p in second.pieces]
    assert [t.heights.tobytes() for t in first.tiles] == [t.heights.tobytes() for t in second.tiles]


def test_a_large_flat_floor_keeps_its_hole(make, compiled, tmp_path):
    keep = np.ones((48, 48), bool)
    keep[20:24, 20:24] = False  # 0.4 m × 0.4 m
    heights = np.zeros((49, 49))
    heights[0] = 1.0  # a ramp at one side, so that the mesh is not flat
    over = make.solid("over", Sphere(0.1), Pose((2.2, 2.2, 0.3)))
    beside = make.solid("beside", Sphere(0.1), Pose((1.0, 2.2, 0.3)))
    c = settle(make, compiled, tmp_path, grid(heights, 0.1, keep), over, beside)
    assert c.model.ngeom < 100
    assert c.data.body("over::link").xpos[2] < -5.0
    assert c.data.body("beside::link").xpos[2] == pytest.approx(0.1, abs=2e-3)


def test_a_ball_between_two_layers_stays_there(make, compiled, tmp_path):
    vertices, faces = grid(np.zeros((41, 41)), 0.1)
    upper = vertices + np.array((0.0, 0.0, 0.5))
    mesh = np.vstack([vertices, upper]), np.vstack([faces, faces + len(vertices)])
    c = settle(make, compiled, tmp_path, mesh, make.solid("ball", Sphere(0.1), Pose((2.0, 2.0, 0.25))))
    assert c.model.ngeom < 10
    assert c.data.body("ball::link").xpos[2] == pytest.approx(0.1, abs=2e-3)


def test_a_box_slides_down_a_fine_ramp_without_catching(make, compiled, tmp_path):
    x, y = np.meshgrid(np.linspace(0, 10, 46), np.linspace(0, 10, 46), indexing="ij")
    heights = -0.5 * x + np.where(y > 9.0, hills(x, y), 0.0)
    box = make.solid(
        "box", Box((0.4, 0.4, 0.2)), Pose.from_rpy(1.5, 4.0, -0.75 + 0.13, 0.0, float(np.arctan(0.5)), 0.0)
    )
    c = settle(make, compiled, tmp_path, grid(heights, 10 / 45), box, steps=0)
    c.model.geom_friction[:, 0] = 0.2
    mujoco.mj_step(c.model, c.data, 1000)
    slope = float(np.arctan(0.5))
    along = (c.data.body("box::link").xpos[0] - 1.5) / np.cos(slope)
    # MuJoCo's elliptic cone lifts a sliding box a little; a box that catches stays behind by more than a tenth
    assert along == pytest.approx(0.5 * 9.8 * (np.sin(slope) - 0.2 * np.cos(slope)), rel=0.1)


def test_a_large_mesh_with_few_flat_areas_stays_exact():
    house = trimesh.creation.box((8.0, 6.0, 3.0))
    for _ in range(5):
        house = house.subdivide()  # 12,288 triangles
    vertices, faces = np.asarray(house.vertices), np.asarray(house.faces, np.int32)
    half = faces[:6000]
    assert not is_large(vertices, half)
    assert is_large(vertices, faces)  # too many to count
    rng = np.random.default_rng(0)
    assert is_large(vertices + rng.normal(0.0, 0.01, vertices.shape), half)


def test_a_turtlebot_drives_over_patches_as_over_a_plane(tmp_path):
    heights = np.zeros((49, 49))
    heights[-1] = 1.0
    vertices, faces = grid(heights, 8 / 48)
    trimesh.Trimesh(vertices - (4, 4, 0), faces, process=False).export(tmp_path / "floor.stl")
    travels = []
    for shape in ("<plane><normal>0 0 1</normal></plane>", "<mesh><uri>floor.stl</uri></mesh>"):
        world = tmp_path / "world.sdf"
        world.write_text(
            '<sdf version="1.9"><world name="w"><model name="floor"><static>true</static><link name="l">'
            f'<collision name="c"><geometry>{shape}</geometry></collision></link></model></world></sdf>'
        )
        with simkit.load(world) as sim:
            robot = sim.spawn(ROBOT, name="robot", pose=Pose((-2.0, 0.1, 0.03)))
            sim.run(0.5)
            start = robot.pose.position[0]
            sim.publish("/cmd_vel", {"linear": {"x": 0.2}})
            sim.run(5.0)
            travels.append(robot.pose.position[0] - start)
    assert travels[0] == pytest.approx(1.0, abs=0.03)
    assert travels[1] == pytest.approx(travels[0], rel=0.01)


@pytest.mark.parametrize("far", [1e3, 1e5])
def test_a_corner_far_away_leaves_the_collisions_of_all_other_triangles(far):
    ball = trimesh.creation.icosphere(subdivisions=4, radius=1.0)
    vertices = np.vstack([ball.vertices, (far, far, far)])
    faces = np.vstack([ball.faces[1:], (*ball.faces[0, :2], len(ball.vertices))]).astype(np.int32)
    bodies = convex_bodies(vertices, faces, fixed=True)
    points = np.vstack([p for p, _ in bodies.shapes] + [tile_surface(t).vertices for t in bodies.tiles])
    distances = np.linalg.norm(points[:, None] - ball.vertices[None, ::40], axis=2).min(axis=0)
    assert distances.max() < 0.2  # every place of the ball is covered
    assert len(bodies.shapes) + len(bodies.tiles) > 100
