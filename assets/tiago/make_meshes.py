"""Draws the visual meshes of TIAGo and its base and writes them as OBJ files into `meshes/`.

    python assets/tiago/make_meshes.py

The shapes are our own, drawn after the robot's published outer dimensions. Each file is one material; coordinates are
metres in the frame of the link that carries the part. Needs trimesh, shapely and mapbox_earcut (the extra `test`).
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import arm_meshes
import base_meshes
import upper_meshes
from solids import Mesh, obj_text

FOLDER = Path(__file__).parent

Draw = Callable[[], list[Mesh]]

PARTS: dict[str, Draw] = {
    "hull_top": base_meshes.hull_top,
    "hull_skirt": base_meshes.hull_skirt,
    "hull_core": base_meshes.hull_core,
    "cover_ring": base_meshes.cover_ring,
    "cover_ring_base": base_meshes.cover_ring_base,
    "laser_housing": base_meshes.laser_housing,
    "wheel_tyre": base_meshes.wheel_tyre,
    "wheel_rim": base_meshes.wheel_rim,
    "caster_fork": base_meshes.caster_fork,
    "torso_foot": upper_meshes.torso_foot,
    "torso_column": upper_meshes.torso_column,
    "torso_shell": upper_meshes.torso_shell,
    "torso_trim": upper_meshes.torso_trim,
    "arm_bracket": upper_meshes.arm_bracket,
    "neck_shell": upper_meshes.neck_shell,
    "head_shell": upper_meshes.head_shell,
    "head_visor": upper_meshes.head_visor,
    "head_lenses": upper_meshes.head_lenses,
    "arm_1": arm_meshes.arm_1,
    "arm_2": arm_meshes.arm_2,
    "arm_3": arm_meshes.arm_3,
    "arm_3_ring": arm_meshes.arm_3_ring,
    "arm_4": arm_meshes.arm_4,
    "arm_5": arm_meshes.arm_5,
    "arm_5_ring": arm_meshes.arm_5_ring,
    "arm_6": arm_meshes.arm_6,
    "arm_7": arm_meshes.arm_7,
    "gripper_palm": arm_meshes.gripper_palm,
    "gripper_rail": arm_meshes.gripper_rail,
    "finger_right": lambda: arm_meshes.finger(1),
    "finger_left": lambda: arm_meshes.finger(-1),
    "finger_right_pad": lambda: arm_meshes.finger_pad(1),
    "finger_left_pad": lambda: arm_meshes.finger_pad(-1),
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
