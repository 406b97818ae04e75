"""Lab 9: the map and the plan against the true shapes; the picture of the README shows the voxels."""

from __future__ import annotations

import shutil
from pathlib import Path

import cv2
import numpy as np
import pytest

import simkit
from simkit.pose import Vector

LAB = Path(__file__).parents[2] / "labs" / "09_octomap"
SIDE = 0.025  # [m] of a cell
FROM = np.array([-0.35, -0.55, 1.75])  # [m], eye of the picture
TO = np.array([0.95, 0.0, 0.78])
SCALE = 640.0  # [px] at a distance of 1 m


def project(points: Vector) -> tuple[Vector, Vector]:
    """Return pixels (n, 2) and distances (n,) of points, as a camera at `FROM` that looks at `TO` sees them."""
    ahead = (TO - FROM) / np.linalg.norm(TO - FROM)
    right = np.cross(ahead, [0, 0, 1]) / np.linalg.norm(np.cross(ahead, [0, 0, 1]))
    down = np.cross(ahead, right)
    away = (points - FROM) @ ahead
    pixels = np.stack([(points - FROM) @ right, (points - FROM) @ down], axis=1) / away[:, None] * SCALE
    return pixels + np.array([400.0, 220.0]), away


def draw(cells: Vector, path: Vector) -> Vector:
    """Return a picture of cells as cubes, coloured by height, and of a path."""
    image = np.full((480, 800, 3), 255, np.uint8)
    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * SIDE - SIDE / 2
    faces = ([0, 1, 3, 2], [0, 1, 5, 4], [1, 3, 7, 5])  # towards the eye: -x, -y, +z
    heights = np.clip((cells[:, 2] - 0.7) / 0.3 * 255, 0, 255).astype(np.uint8)
    colours = cv2.applyColorMap(heights[:, None], cv2.COLORMAP_VIRIDIS)
    for k in np.argsort(-np.linalg.norm(cells - FROM, axis=1)):
        pixels = project(cells[k] + corners)[0].round().astype(np.int32)
        for face, light in zip(faces, (0.75, 0.9, 1.0), strict=True):
            cv2.fillConvexPoly(image, pixels[face], [float(c) * light for c in colours[k].ravel()[:3]], cv2.LINE_AA)
    line = project(path)[0].round().astype(np.int32)
    cv2.polylines(image, [line], False, (40, 40, 220), 3, cv2.LINE_AA)
    cv2.circle(image, tuple(int(v) for v in line[-1]), 7, (40, 40, 220), -1, cv2.LINE_AA)
    return image


@pytest.mark.labs
def test_the_map_and_the_plan_agree_with_the_world(tmp_path: Path) -> None:
    """To renew the picture, copy the file that the failure names."""
    folder = tmp_path / "lab"
    shutil.copytree(LAB, folder, ignore=shutil.ignore_patterns("solution", "__pycache__"))
    shutil.copy(LAB / "solution" / "mapper.py", folder)
    path, touched = [], set()
    with simkit.load(folder / "lab.sdf", plugin_paths=[folder], seed=3) as sim:
        robot = sim.model("tiago")
        cells = sim.subscribe("/octomap_point_cloud_centers", keep=1)
        numbers = {n: sim.subscribe(f"/referee/{n}", keep=1) for n in ("table_cells", "wrong_cells", "pose_error")}
        while sim.time < 16.0:
            sim.run(0.05)
            if cells.latest is not None:
                path.append(np.array(robot.link("gripper_grasping_frame").pose.position))
            names = {name.split("::")[0] for c in sim.contacts("tiago") for name in (c.first, c.second)}
            touched |= names - {"tiago", "ground_plane"}
        found = {name: heard.latest.data for name, heard in numbers.items()}
        centres = np.frombuffer(cells.latest.data, "<f4").reshape(-1, 3).astype(float)
    assert found["table_cells"] >= 0.95 and found["wrong_cells"] <= 0.01 and found["pose_error"] < 0.002
    assert touched == set()
    # the way of the point between the fingers is clear of all voxels
    away = min(float(np.abs(centres - point).max(axis=1).min()) for point in path)
    assert away > SIDE / 2
    drawn = draw(centres, np.array(path))
    cv2.imwrite(str(tmp_path / "voxels.png"), drawn)
    shown = cv2.imread(str(LAB / "voxels.png"))
    # renderers differ in single points of a cloud: a few cells at edges
    assert shown is not None and np.mean(np.abs(shown.astype(int) - drawn).max(axis=2) > 40) < 0.02, (
        tmp_path / "voxels.png"
    )
