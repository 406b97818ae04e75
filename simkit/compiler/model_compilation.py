"""Compile a world's specification, and adjust the model that comes of it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import mujoco

from simkit.compiler.engine_options import apply_size, choose_islands, set_extent
from simkit.compiler.initial_state import add_idle_armature, apply_velocity_decay, check_derived_numbers
from simkit.compiler.lights import refine_for_lamps
from simkit.compiler.mjcf_attachment import assign_geom_groups, silence_engine_warnings
from simkit.compiler.name_map import ModelRecord
from simkit.compiler.refused_inertias import restore_file_inertias
from simkit.compiler.servo_gains import tune_servos
from simkit.diagnostics import Diagnostics
from simkit.scene import SceneWorld

MOST_MOVING: Final = 10_000
"""Links; the engine's compiler takes time in proportion to their square, 7 s for 4000 that are free."""


def compile_spec(
    spec: mujoco.MjSpec, world: SceneWorld, records: Sequence[ModelRecord], diagnostics: Diagnostics
) -> mujoco.MjModel:
    """The model that a specification compiles to.

    Raises:
        LoadError: there are too many moving links, or MuJoCo refuses the model.
    """
    moving = sum(not link.static for r in records for link in r.links.values())
    if moving > MOST_MOVING:
        message = (
            f"there are {moving} moving links; at most {MOST_MOVING} are compiled, which takes the engine a minute"
        )
        diagnostics.error("SK-PHYS-029", message, world.where, "make what never moves <static>")
        diagnostics.raise_if_errors()
    apply_size(spec, sum(not o.is_visual for r in records for o in r.geoms.values()))
    if world.mjcf is None:
        choose_islands(spec, sum(len(r.root_bodies) for r in records))
    try:
        with silence_engine_warnings():
            return spec.compile()
    except ValueError as problem:
        diagnostics.error("SK-PHYS-023", f"MuJoCo refuses the model: {problem}", world.where)
        diagnostics.raise_if_errors()
        raise AssertionError("unreachable") from problem


def finish_model(
    spec: mujoco.MjSpec,
    model: mujoco.MjModel,
    world: SceneWorld,
    records: Sequence[ModelRecord],
    diagnostics: Diagnostics,
) -> None:
    """Sets what only the compiled model tells: inertias, groups, damping, gains. Raises LoadError (SK-PHYS-028)."""
    restore_file_inertias(model, {name: exact for r in records for name, exact in r.exact.items()})
    check_derived_numbers(model, diagnostics, world.where)
    set_extent(model)
    if world.mjcf is None:
        refine_for_lamps(model)
    assign_geom_groups(model, records)
    apply_velocity_decay(model, records)
    add_idle_armature(spec, model, records, diagnostics)
    tune_servos(spec, model, [ref for r in records for ref in r.actuators])
