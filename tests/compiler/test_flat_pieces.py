"""Convex pieces without a thickness, which MuJoCo refuses, collide as thin plates."""

from __future__ import annotations

import mujoco
import numpy as np

from simkit.compiler.assets import mesh_bytes
from simkit.compiler.model_compilation import compile_spec
from simkit.diagnostics import Diagnostics
from simkit.scene import SceneWorld

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0.5, 0.5, 0]], float)


def spec_with(*pieces: np.ndarray) -> mujoco.MjSpec:
    spec = mujoco.MjSpec()
    for number, vertices in enumerate(pieces):
        mesh = spec.add_mesh(name=f"mesh#abcdef{number}")
        mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
        mesh.file = f"piece{number}.msh"
        spec.assets[mesh.file] = mesh_bytes(vertices, np.zeros((0, 3), np.int32))
        geom = spec.worldbody.add_geom(name=f"g{number}", type=mujoco.mjtGeom.mjGEOM_MESH)
        geom.meshname = mesh.name
    return spec


def test_flat_pieces_become_plates_with_their_outline() -> None:
    diagnostics = Diagnostics()
    tilted = SQUARE[:, [2, 0, 1]] * 0.01
    model = compile_spec(spec_with(SQUARE, tilted), SceneWorld("w"), (), diagnostics)
    assert [d.code for d in diagnostics] == ["SK-MESH-007"]  # both notes have one text here
    assert np.allclose(sorted(model.geom_size[0]), [0.0007, 0.5, 0.5], atol=1e-4)
    assert np.allclose(sorted(model.geom_size[1]), [7e-6, 0.005, 0.005], atol=1e-6)


def test_a_piece_with_a_thickness_is_unchanged() -> None:
    diagnostics = Diagnostics()
    cube = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    assert compile_spec(spec_with(cube), SceneWorld("w"), (), diagnostics).mesh_vertnum.tolist() == [8]
    assert not list(diagnostics)
