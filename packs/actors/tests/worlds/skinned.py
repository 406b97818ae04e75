"""A small skinned COLLADA file for tests: a hip and a leg of 0.5 m, which swings by a quarter turn within a second."""

from __future__ import annotations

import numpy as np

_BOX = np.array([[x, y, z] for x in (-0.1, 0.1) for y in (-0.1, 0.1) for z in (0.0, 0.4)])
_FACES = [
    (0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (1, 3, 7), (1, 7, 5),
    (0, 4, 6), (0, 6, 2),
]  # fmt: skip


def _source(name: str, values: np.ndarray, stride: int) -> str:
    text = " ".join(f"{v:.9g}" for v in np.ravel(values))
    count = np.size(values)
    return (
        f'<source id="{name}"><float_array id="{name}-array" count="{count}">{text}</float_array><technique_common>'
        f'<accessor source="#{name}-array" count="{count // stride}" stride="{stride}"/></technique_common></source>'
    )


def _matrix(m: np.ndarray) -> str:
    return " ".join(f"{v:.9g}" for v in m.ravel())


def _moved(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> np.ndarray:
    m = np.eye(4)
    m[:3, 3] = x, y, z
    return m


def _turned(angle: float) -> np.ndarray:
    """About y."""
    m, c, s = np.eye(4), np.cos(angle), np.sin(angle)
    m[0, 0], m[0, 2], m[2, 0], m[2, 2] = c, s, -s, c
    return m


def skinned_dae(*, hip_height: float = 1.0, unit: float = 1.0, way: float = 0.0, name: str = "hip") -> str:
    """The file as text.

    Args:
        hip_height: of the hip over the ground [m].
        unit: [m].
        way: that the hip goes along x in the animation's second [m].
        name: of the outer bone.
    """
    hip, leg = _moved(z=hip_height / unit), _moved(z=-0.5 / unit)
    bind = np.array([hip, hip @ leg])
    upper, lower = _BOX / unit + (0, 0, hip_height / unit), _BOX / unit + (0, 0, (hip_height - 0.5) / unit)
    points = np.vstack([upper, lower])
    faces = [*_FACES, *(tuple(i + 8 for i in face) for face in _FACES)]
    times = np.linspace(0.0, 1.0, 11)
    hips = np.array([_moved(way * t / unit) @ hip for t in times])
    legs = np.array([leg @ _turned(t * np.pi / 2) for t in times])

    def animation(bone: str, frames: np.ndarray) -> str:
        return (
            f'<animation id="a-{bone}">{_source(f"{bone}-in", times, 1)}{_source(f"{bone}-out", frames, 16)}'
            f'<sampler id="{bone}-s"><input semantic="INPUT" source="#{bone}-in"/>'
            f'<input semantic="OUTPUT" source="#{bone}-out"/></sampler>'
            f'<channel source="#{bone}-s" target="{bone}/transform"/></animation>'
        )

    flat = " ".join(str(i) for face in faces for i in face)
    return f"""<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="u" meter="{unit}"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>{_source("p", points, 3)}
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="{len(faces)}"><input semantic="VERTEX" source="#v" offset="0"/><p>{flat}</p></triangles>
</mesh></geometry></library_geometries>
<library_controllers><controller id="c"><skin source="#g"><bind_shape_matrix>{_matrix(np.eye(4))}</bind_shape_matrix>
<source id="j"><Name_array id="ja" count="2">{name} leg</Name_array></source>{_source("ib", np.linalg.inv(bind), 16)}
{_source("w", np.ones(1), 1)}
<joints><input semantic="JOINT" source="#j"/><input semantic="INV_BIND_MATRIX" source="#ib"/></joints>
<vertex_weights count="16"><input semantic="JOINT" source="#j" offset="0"/>
<input semantic="WEIGHT" source="#w" offset="1"/><vcount>{"1 " * 16}</vcount>
<v>{"0 0 " * 8}{"1 0 " * 8}</v></vertex_weights></skin></controller></library_controllers>
<library_animations>{animation(name, hips)}{animation("leg", legs)}</library_animations>
<library_visual_scenes><visual_scene id="s"><node id="{name}" name="{name}" type="JOINT">
<matrix sid="transform">{_matrix(hip)}</matrix><node id="leg" name="leg" type="JOINT">
<matrix sid="transform">{_matrix(leg)}</matrix></node></node>
<node id="mesh"><instance_controller url="#c"><skeleton>#{name}</skeleton></instance_controller></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>
"""
