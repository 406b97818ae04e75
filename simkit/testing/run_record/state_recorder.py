"""Recorder of a run's physics: fields of the compiled model, a hash for each tick, and some complete states."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Mapping
from typing import Final
from zlib import crc32

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.runtime import Simulation
from simkit.runtime.engine.physics_step import Physics
from simkit.runtime.engine.snapshot import state_hash
from simkit.testing.run_record.record import Array, States

_STATES_KEPT: Final = 64  # maximum number of stored states
_MAX_VALUES: Final = 6000  # maximum number of values in all stored states
_MIN_STATES: Final = 3
_MAX_WATCHED_BODIES: Final = 200  # in a world with more bodies, forces are hashed only after a write access


class StateRecorder:
    """Recorder of the physics at every tick.

    Args:
        sim: Simulation.
        ticks: Maximum number of steps of the run.
    """

    def __init__(self, sim: Simulation, ticks: int) -> None:
        self._sim, self._ticks = sim, max(1, ticks)
        self._marks, self._inputs = bytearray(), bytearray()
        self._kept: list[tuple[int, dict[str, float], dict[str, float]]] = []
        self._data: mujoco.MjData
        self._edition = -1
        self._is_active = True
        self._every, self._input_mark = 1, 0
        self._has_more = self._listens = False
        self._bind_model()
        self._keep()
        sim.communication.on_demand.add(lambda: self._is_active, None, self._mark, "after")

    def close(self) -> None:
        """Stop recording."""
        if self._is_active:
            self._is_active = False
            self._sim.communication.on_demand.look()

    def states(self) -> States:
        """Return the recorded states, including the present one."""
        self._keep()
        names = _union(state for _, state, _ in self._kept)
        inputs = _union(input_values for _, _, input_values in self._kept)
        marks = np.frombuffer(bytes(self._marks), np.uint8)
        last = self._kept[-1][1]
        digest = hashlib.sha256(marks.tobytes())
        for name in sorted(last):
            digest.update(f"{name}={last[name]!r};".encode())
        return States(
            timestep=self._sim.timestep,
            marks=marks,
            inputs=np.frombuffer(bytes(self._inputs), np.uint8),
            ticks=np.array([tick for tick, _, _ in self._kept], np.int64),
            names=names,
            values=_state_table([state for _, state, _ in self._kept], names),
            input_names=inputs,
            input_values=_state_table([input_values for _, _, input_values in self._kept], inputs),
            digest=state_hash(self._sim),
            named_digest=digest.hexdigest(),
        )

    # ------------------------------------------------------------------ every tick

    def _mark(self, _: int) -> None:
        physics = self._sim.engine.physics
        if physics.data is not self._data:
            self._bind_model()
        state = crc32(self._qvel.take(self._dofs).data, crc32(self._qpos.take(self._positions).data))
        if self._has_more:
            data = self._data
            state = crc32(data.act[self._activations].data, crc32(data.mocap_pos[self._mocaps].data, state))
            state = crc32(data.mocap_quat[self._mocaps].data, state)
        state ^= state >> 16  # fold all bits into the last byte
        self._marks.append((state ^ (state >> 8)) & 0xFF)
        if physics.edition != self._edition or self._listens:
            self._edition = physics.edition
            self._input_mark = self._hash_inputs(physics)
        self._inputs.append(self._input_mark)
        if len(self._marks) % self._every == 0:
            self._keep()

    def _hash_inputs(self, physics: Physics) -> int:
        checksum = crc32(self._ctrl.take(self._controls).data)
        applied, pushed = self._applied, self._pushed
        if physics.shows_applied:  # forces for one step are already cleared; use their stored values
            applied, pushed = physics.last_applied + applied, physics.last_pushed + pushed
        if crc32(applied.data) != self._no_force:
            checksum = crc32(applied.take(self._dofs).data, checksum)
        if crc32(pushed.data) != self._no_push:
            checksum = crc32(pushed[self._bodies].data, checksum)
        checksum ^= checksum >> 16
        return (checksum ^ (checksum >> 8)) & 0xFF

    # ------------------------------------------------------------------ names

    def _bind_model(self) -> None:
        """Store the arrays and the names of the present model."""
        physics = self._sim.engine.physics
        model, data = physics.model, physics.data
        self._data = data
        self._qpos, self._qvel, self._ctrl = data.qpos, data.qvel, data.ctrl
        self._applied, self._pushed = data.qfrc_applied, data.xfrc_applied
        self._no_force, self._no_push = crc32(bytes(8 * model.nv)), crc32(bytes(48 * model.nbody))
        named = StateQuantities(model)
        self._named = named
        self._positions, self._dofs = _sort_by_name(named.positions), _sort_by_name(named.velocities)
        self._controls, self._activations = _sort_by_name(named.controls), _sort_by_name(named.activations)
        self._bodies, self._mocaps = _sort_by_name(named.bodies), _sort_by_name(named.mocaps)
        self._has_more = bool(model.na or model.nmocap)
        self._listens = model.nbody <= _MAX_WATCHED_BODIES
        self._edition, self._input_mark = -1, 0
        width = model.nq + model.nv + model.nu + 1
        state_count = int(np.clip(_MAX_VALUES // width, _MIN_STATES, _STATES_KEPT))
        self._every = max(1, -(-self._ticks // state_count))

    def _keep(self) -> None:
        """Store the complete state."""
        tick = len(self._marks)
        if self._kept and self._kept[-1][0] == tick:
            return
        physics = self._sim.engine.physics
        if physics.data is not self._data:
            self._bind_model()
        self._kept.append((tick, *self._named.values(physics)))


class StateQuantities:
    """Names of the state quantities of a compiled model, in the engine's order."""

    def __init__(self, model: mujoco.MjModel) -> None:
        self.bodies = _names(model, mujoco.mjtObj.mjOBJ_BODY, model.nbody)
        joints = _names(model, mujoco.mjtObj.mjOBJ_JOINT, model.njnt)
        self.controls = _names(model, mujoco.mjtObj.mjOBJ_ACTUATOR, model.nu)
        self.positions = [""] * model.nq
        self.velocities = [""] * model.nv
        free, ball = int(mujoco.mjtJoint.mjJNT_FREE), int(mujoco.mjtJoint.mjJNT_BALL)
        for joint, name in enumerate(joints):
            kind, body_name = int(model.jnt_type[joint]), self.bodies[int(model.jnt_bodyid[joint])]
            place, speed = int(model.jnt_qposadr[joint]), int(model.jnt_dofadr[joint])
            if kind == free:
                self.positions[place : place + 7] = [f"{body_name} {part}" for part in _FREE_POSITION]
                self.velocities[speed : speed + 6] = [f"{body_name} {part}" for part in _FREE_VELOCITY]
            elif kind == ball:
                self.positions[place : place + 4] = [f"{name} orientation {part}" for part in "wxyz"]
                self.velocities[speed : speed + 3] = [f"{name} velocity {part}" for part in "xyz"]
            else:
                self.positions[place], self.velocities[speed] = f"{name} position", f"{name} velocity"
        self.activations = [f"activation {i}" for i in range(model.na)]
        for actuator, motor in enumerate(self.controls):
            start, count = int(model.actuator_actadr[actuator]), int(model.actuator_actnum[actuator])
            for at in range(start, start + count if start >= 0 else start):
                self.activations[at] = f"{motor} activation" + (f" {at - start}" if count > 1 else "")
        self.mocaps = [""] * model.nmocap
        for body, number in enumerate(model.body_mocapid.tolist()):
            if number >= 0:
                self.mocaps[number] = self.bodies[body]
        self.forces = [f"force on {name}" for name in self.velocities]

    def values(self, physics: Physics) -> tuple[dict[str, float], dict[str, float]]:
        """Return the state and the inputs by name; forces of zero are left out."""
        data = physics.data
        state = dict(zip(self.positions, data.qpos.tolist(), strict=True))
        state.update(zip(self.velocities, data.qvel.tolist(), strict=True))
        state.update(zip(self.activations, data.act.tolist(), strict=True))
        for name, position, turn in zip(self.mocaps, data.mocap_pos.tolist(), data.mocap_quat.tolist(), strict=True):
            state.update((f"{name} {part}", v) for part, v in zip(_FREE_POSITION, [*position, *turn], strict=True))
        inputs = {f"control {name}": value for name, value in zip(self.controls, data.ctrl.tolist(), strict=True)}
        applied, pushed = physics.applied_forces()
        for at in np.flatnonzero(applied):
            inputs[self.forces[int(at)]] = float(applied[at])
        for body, part in zip(*np.nonzero(pushed), strict=True):
            inputs[f"{_WRENCH[int(part)]} on {self.bodies[int(body)]}"] = float(pushed[body, part])
        return state, inputs


_FREE_POSITION: Final = ("position x", "position y", "position z", *(f"orientation {part}" for part in "wxyz"))
_FREE_VELOCITY: Final = (*(f"velocity {part}" for part in "xyz"), *(f"angular velocity {part}" for part in "xyz"))
_WRENCH: Final = (*(f"push {part}" for part in "xyz"), *(f"torque {part}" for part in "xyz"))


def _sort_by_name(names: list[str]) -> npt.NDArray[np.intp]:
    """Return the indices that sort the names."""
    return np.array(sorted(range(len(names)), key=names.__getitem__), dtype=np.intp)


def _union(states: Iterable[Iterable[str]]) -> list[str]:
    return sorted({name for state in states for name in state})


def _state_table(states: list[dict[str, float]], names: list[str]) -> npt.NDArray[np.float64]:
    """Return a table with one row for each state. A quantity that a state does not have is NaN."""
    values = [[state.get(name, np.nan) for name in names] for state in states]
    return np.array(values, dtype=np.float64).reshape(len(states), len(names))


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
"""Endings of fields that contain indices of the model's lists; these indices depend on the order in the file."""
_BINARY_FIELDS: Final = {"mesh": ("vert", "face"), "hfield": ("data",), "tex": ("data",)}


class ModelFields(Mapping[str, Array]):
    """Fields of named model elements, with keys such as `geom robot::wheel::collision size`.

    Args:
        tables: Element kind -> names, and an array with one row per name for each field.
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
    """Return the fields of a simulation's compiled model."""
    model = sim.engine.physics.model
    tables: dict[str, tuple[list[str], dict[str, Array]]] = {"option": (["engine"], _options(model.opt))}
    members = [name for name in dir(model) if not name.startswith("_")]
    for kind, (count, obj) in _KINDS.items():
        size = int(getattr(model, count))
        if not size:
            continue
        names = (
            StateQuantities(model).velocities
            if kind == "dof"
            else _names(model, getattr(mujoco.mjtObj, f"mjOBJ_{obj}"), size)
        )
        order = _sort_by_name(names)
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
    numbers = {}
    for name in dir(options):
        value = None if name.startswith("_") else getattr(options, name)
        if isinstance(value, (int, float, np.ndarray)) and not isinstance(value, bool):
            numbers[name] = np.array([value], dtype=np.float64)
    return numbers


def _names(model: mujoco.MjModel, kind: mujoco.mjtObj, size: int) -> list[str]:
    return [mujoco.mj_id2name(model, kind, i) or f"#{i}" for i in range(size)]


def _add_meshes(model: mujoco.MjModel, tables: dict[str, tuple[list[str], dict[str, Array]]]) -> None:
    """Add the number of vertices and faces and a hash of the content of each mesh."""
    if not model.nmesh:
        return
    names = _names(model, mujoco.mjtObj.mjOBJ_MESH, model.nmesh)
    order = _sort_by_name(names)
    rows = []
    for i in order.tolist():
        start, count = int(model.mesh_vertadr[i]), int(model.mesh_vertnum[i])
        face, faces = int(model.mesh_faceadr[i]), int(model.mesh_facenum[i])
        digest = hashlib.sha256(model.mesh_vert[start : start + count].tobytes())
        digest.update(model.mesh_face[face : face + faces].tobytes())
        rows.append((count, faces, int.from_bytes(digest.digest()[:6], "big")))
    table = {name: np.array([row[i] for row in rows]) for i, name in enumerate(("vertices", "faces", "content"))}
    tables["mesh"] = ([names[i] for i in order], table)
