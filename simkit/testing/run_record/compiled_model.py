"""The compiled model by names: what the engine saw of a world."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.testing.run_record.record import Array

if TYPE_CHECKING:
    import mujoco

    from simkit.runtime import Simulation

_KINDS: Final = {
    "body": ("nbody", "BODY"),
    "jnt": ("njnt", "JOINT"),
    "geom": ("ngeom", "GEOM"),
    "site": ("nsite", "SITE"),
    "cam": ("ncam", "CAMERA"),
    "light": ("nlight", "LIGHT"),
    "mat": ("nmat", "MATERIAL"),
    "hfield": ("nhfield", "HFIELD"),
    "eq": ("neq", "EQUALITY"),
    "tendon": ("ntendon", "TENDON"),
    "actuator": ("nu", "ACTUATOR"),
    "sensor": ("nsensor", "SENSOR"),
    "pair": ("npair", "PAIR"),
    "dof": ("nv", ""),
}
_NAMES: Final = {"jnt": "joint", "cam": "camera", "mat": "material", "eq": "equality", "hfield": "heightmap"}
_NUMBERING: Final = ("adr", "num", "id", "simple", "sameframe", "plugin", "signature", "priority_")
"""Endings of fields that say where something stands in the model's lists, which the order of a file decides."""
_BINARY_FIELDS: Final = {"mesh": ("vert", "face"), "hfield": ("data",), "tex": ("data",)}


class ModelFields(Mapping[str, Array]):
    """Fields of named parts, as `geom robot::wheel::collision size`.

    Args:
        tables: part -> names and, by field, an array with a row for each.
    """

    def __init__(self, tables: Mapping[str, tuple[list[str], Mapping[str, Array]]]) -> None:
        self.tables = tables
        self._rows = {kind: {name: row for row, name in enumerate(names)} for kind, (names, _) in tables.items()}

    def __getitem__(self, key: str) -> Array:
        kind, _, rest = key.partition(" ")
        name, _, field = rest.rpartition(" ")
        table = self.tables[kind]
        return np.asarray(table[1][field][self._rows[kind][name]])

    def __iter__(self) -> Iterator[str]:
        for kind, (names, table) in self.tables.items():
            for name in names:
                yield from (f"{kind} {name} {field}" for field in table)

    def __len__(self) -> int:
        return sum(len(names) * len(table) for names, table in self.tables.values())


def fields_of_model(sim: Simulation) -> ModelFields:
    """The fields of a simulation's compiled model."""
    import mujoco

    model = sim.engine.physics.model
    tables: dict[str, tuple[list[str], dict[str, Array]]] = {"option": (["engine"], _options(model.opt))}
    members = [name for name in dir(model) if not name.startswith("_")]
    for kind, (count, obj) in _KINDS.items():
        size = int(getattr(model, count))
        if not size:
            continue
        names = _dof_names(model) if kind == "dof" else _names(model, getattr(mujoco.mjtObj, f"mjOBJ_{obj}"), size)
        order = np.array(sorted(range(size), key=names.__getitem__), dtype=np.intp)
        table = {}
        for member in members:
            field = member.removeprefix(kind + "_")
            if member == field or field.endswith(_NUMBERING):
                continue
            array = getattr(model, member)
            if isinstance(array, np.ndarray) and array.ndim and len(array) == size:
                table[field] = array[order].copy()
        tables[_NAMES.get(kind, kind)] = ([names[i] for i in order], table)
    _add_meshes(model, tables)
    return ModelFields(tables)


def _options(options: object) -> dict[str, Array]:
    found = {}
    for name in dir(options):
        value = None if name.startswith("_") else getattr(options, name)
        if isinstance(value, (int, float, np.ndarray)) and not isinstance(value, bool):
            found[name] = np.array([value], dtype=np.float64)
    return found


def _names(model: mujoco.MjModel, kind: mujoco.mjtObj, size: int) -> list[str]:
    import mujoco

    return [mujoco.mj_id2name(model, kind, i) or f"#{i}" for i in range(size)]


def _dof_names(model: mujoco.MjModel) -> list[str]:
    from simkit.testing.run_record.state_recorder import StateQuantities

    return StateQuantities(model).velocities


def _add_meshes(model: mujoco.MjModel, tables: dict[str, tuple[list[str], dict[str, Array]]]) -> None:
    """Meshes by how many vertices and faces they have, and a hash of those."""
    import mujoco

    if not model.nmesh:
        return
    names = _names(model, mujoco.mjtObj.mjOBJ_MESH, model.nmesh)
    order = sorted(range(model.nmesh), key=names.__getitem__)
    rows = []
    for i in order:
        start, count = int(model.mesh_vertadr[i]), int(model.mesh_vertnum[i])
        face, faces = int(model.mesh_faceadr[i]), int(model.mesh_facenum[i])
        digest = hashlib.sha256(model.mesh_vert[start : start + count].tobytes())
        digest.update(model.mesh_face[face : face + faces].tobytes())
        rows.append((count, faces, int.from_bytes(digest.digest()[:6], "big")))
    table = {name: np.array([row[i] for row in rows]) for i, name in enumerate(("vertices", "faces", "content"))}
    tables["mesh"] = ([names[i] for i in order], table)
