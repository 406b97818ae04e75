"""Draws the visual meshes of Baxter and writes them as OBJ files into `meshes/`.

    python assets/baxter/make_meshes.py

The shapes are our own, drawn after the frames and the collision shapes of the published description. Each file is one
material; coordinates are metres in the frame of the link that carries the part. Needs trimesh, shapely and
mapbox_earcut (the extra `test`).
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import arm_meshes
import body_meshes
from links import JOINTS
from solids import Mesh, obj_text

FOLDER = Path(__file__).parent

Draw = Callable[[], list[Mesh]]

PARTS: dict[str, Draw] = {
    **{
        name: getattr(body_meshes, name)
        for name in (
            *("pedestal_column", "pedestal_legs", "pedestal_feet", "torso_shell", "torso_core", "torso_neck"),
            *("head_neck", "screen_shell", "screen_frame", "screen_display", "screen_eyes", "screen_pupils"),
        )
    },
    **{name: getattr(arm_meshes, name) for link in JOINTS for name in (link, f"{link}_motor")},
    **{name: getattr(arm_meshes, name) for name in ("hand_cuff", "gripper_palm", "gripper_rail")},
    "finger_l": lambda: arm_meshes.finger(1),
    "finger_r": lambda: arm_meshes.finger(-1),
    "paddle_l": lambda: arm_meshes.paddle(1),
    "paddle_r": lambda: arm_meshes.paddle(-1),
}
"""What is drawn: name of the file, and the function that draws it."""


def main() -> None:
    meshes = FOLDER / "meshes"
    meshes.mkdir(parents=True, exist_ok=True)
    for name, draw in PARTS.items():
        text = obj_text(name, draw())
        (meshes / f"{name}.obj").write_text(text, encoding="utf-8")
        print(f"{name:20s} {text.count(chr(10) + 'f '):6d} triangles")


if __name__ == "__main__":
    main()
