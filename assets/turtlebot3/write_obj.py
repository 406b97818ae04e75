"""Meshes as OBJ text."""

from __future__ import annotations

import numpy as np
import trimesh


def obj_text(name: str, parts: list[trimesh.Trimesh], *, smooth: bool = False) -> str:
    """The parts as one OBJ: with a normal for each face, or with none where the reader shall smooth the edges."""
    lines = [f"# {name}: written by make_meshes.py", f"o {name}"]
    faces: list[str] = []
    vertices: dict[tuple[str, ...], int] = {}
    normals: dict[tuple[str, ...], int] = {}

    def index(table: dict[tuple[str, ...], int], values: np.ndarray, digits: int) -> int:
        key = tuple(f"{round(float(v), digits) + 0.0:.{digits}f}" for v in values)
        return table.setdefault(key, len(table) + 1)

    for mesh in parts:
        for triangle in mesh.triangles:
            normal = np.cross(triangle[1] - triangle[0], triangle[2] - triangle[0])
            length = float(np.linalg.norm(normal))
            corners = [index(vertices, corner, 5) for corner in triangle]
            if len(set(corners)) == 3 and length > 1e-12:
                ending = "" if smooth else f"//{index(normals, normal / length, 3)}"
                faces.append("f " + " ".join(f"{c}{ending}" for c in corners))
    lines += ["v " + " ".join(v) for v in vertices]
    lines += ["vn " + " ".join(n) for n in normals]
    return "\n".join([*lines, *faces]) + "\n"
