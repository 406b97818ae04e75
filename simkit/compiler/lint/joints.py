"""Checks of joint gains and springs against inertia and time step, of joint ranges, and of loads on light links."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import mujoco

from simkit.compiler.actuator_gains import unstable_gains
from simkit.compiler.first_state import first_mass_matrix, first_state, inverse_inertia
from simkit.compiler.name_map import JointBinding
from simkit.compiler.spec_builder import Compiled
from simkit.diagnostics import NOWHERE, Diagnostics, Where
from simkit.params import Params
from simkit.scene import SceneWorld

_GAIN_LIMIT: Final = 1.5  # as in simkit.compiler.servo_gains, which reduces larger gains
_RINGING_DAMPING: Final = 2.0  # largest d·dt/I for a force that is computed once a step
_RINGING_STIFFNESS: Final = 4.0  # largest k·dt²/I for a force that is computed once a step
LARGEST_LOAD_RATIO: Final = 1e4
"""Ratio of the mass on a moving body to the body's own mass, above which the contact penetrates by more than 1 mm."""


@dataclass(frozen=True, slots=True)
class JointGains:
    """Gains that a plugin of the file requests for one joint.

    Attributes:
        plugin: name of the plugin.
        joint: name of the joint, as the file has it.
        p: effort per position error [N·m/rad or N/m].
        d: effort per rate of the position error [N·m·s/rad or N·s/m].
        where: file position of the plugin.
    """

    plugin: str
    joint: str
    p: float
    d: float
    where: Where


def check_joints(world: SceneWorld, compiled: Compiled, diagnostics: Diagnostics) -> None:
    """Report unstable gains, springs too stiff for the step, empty joint ranges, and heavy loads on light links."""
    inertias = _JointInertia(compiled.model)
    step = world.physics.max_step_size
    for joint in compiled.names.joints.values():
        _check_range(joint, diagnostics)
        _check_spring(joint, inertias, step, diagnostics)
    _check_servos(compiled, inertias, step, diagnostics)
    _check_actuators(compiled, diagnostics)
    for model in world.models:
        for nested in model.all_models():
            for plugin in nested.plugins:
                for gains in controller_gains(plugin.params, plugin.name or plugin.filename, plugin.where):
                    _check_gains(gains, _find_joint(compiled, nested.scoped, gains.joint), inertias, step, diagnostics)
    _check_loads(compiled, diagnostics)


class _JointInertia:
    """Inertia [kg·m² or kg] at a degree of freedom in the first state, with all others free: 1 / (M⁻¹)_jj."""

    def __init__(self, model: mujoco.MjModel) -> None:
        self._model = model
        self._data: mujoco.MjData | None = None
        self._known: dict[int, float] = {}

    def at(self, dof: int) -> float:
        if dof not in self._known:
            if self._data is None:
                self._data = first_mass_matrix(self._model)
            self._known[dof] = 1.0 / max(inverse_inertia(self._model, self._data, dof), 1e-300)
        return self._known[dof]


def _check_range(joint: JointBinding, diagnostics: Diagnostics) -> None:
    for axis in joint.scene.axes:
        if joint.type in ("revolute", "prismatic", "universal", "revolute2") and axis.lower == axis.upper:
            message = f"joint {joint.scoped!r} is {joint.type} but cannot move: both limits are {axis.lower:g}"
            diagnostics.note(
                "SK-LINT-005", message, joint.scene.where, "use a joint of type fixed, which costs no computing time"
            )


def _check_spring(joint: JointBinding, inertias: _JointInertia, step: float, diagnostics: Diagnostics) -> None:
    for axis, dof in zip(joint.scene.axes, joint.dofs, strict=False):
        if axis.stiffness > 0 and (number := axis.stiffness * step**2 / inertias.at(dof)) > 1.0:
            diagnostics.warning(
                "SK-LINT-004",
                f"joint {joint.scoped!r}: its spring of {axis.stiffness:g} on an inertia of "
                f"{inertias.at(dof):.3g} oscillates too fast for the step of {step * 1e3:g} ms "
                f"(k·dt²/I is {number:.3g}, it should be at most 1)",
                joint.scene.where,
                f"use a spring of at most {inertias.at(dof) / step**2:.3g}, or a smaller step",
            )


def _check_servos(compiled: Compiled, inertias: _JointInertia, step: float, diagnostics: Diagnostics) -> None:
    """Report gains that are larger than a servo can use at this step."""
    for record in compiled.builder.records.values():
        for ref in record.actuators:
            joint = compiled.names.joints.get(ref.joint)
            if joint is None or ref.axis >= len(joint.dofs) or ref.kv is None:
                continue
            inertia = inertias.at(joint.dofs[ref.axis])
            most = _GAIN_LIMIT * inertia / step
            if ref.kv > most:
                message = (
                    f"joint {joint.scoped!r}: the velocity gain {ref.kv:g} of {ref.owner} would oscillate at a "
                    f"step of {step * 1e3:g} ms on an inertia of {inertia:.3g}; {most:.3g} is used"
                )
                diagnostics.warning("SK-LINT-003", message, joint.scene.where, "use a smaller gain or a smaller step")


def _check_actuators(compiled: Compiled, diagnostics: Diagnostics) -> None:
    """Report actuators of MJCF that diverge; those of plugins have stable gains."""
    places = {dof: joint.scene.where for joint in compiled.names.joints.values() for dof in joint.dofs}
    for gain in unstable_gains(compiled.model):
        diagnostics.warning("SK-LINT-003", gain.message, places.get(gain.dof, NOWHERE), gain.hint)


def controller_gains(params: Params, name: str, where: Where) -> Iterator[JointGains]:
    """Yield the gains of Gazebo's joint controllers: one joint with `p_gain`, or several with `position_p_gain`."""
    joints = [c.value for c in params.children if c.name == "joint_name"]
    p = _numbers(params, "p_gain") or _numbers(params, "position_p_gain")
    d = _numbers(params, "d_gain") or _numbers(params, "position_d_gain")
    if any(c.name in ("use_force_commands", "velocity_p_gain") for c in params.children):
        return  # with these parameters the gains act on a velocity error
    for i, joint in enumerate(joints):
        yield JointGains(name, joint, _item_or_last(p, i), _item_or_last(d, i), where)


def _item_or_last(values: list[float], i: int) -> float:
    return values[min(i, len(values) - 1)] if values else 0.0


def _numbers(params: Params, name: str) -> list[float]:
    values = []
    for child in params.children:
        if child.name == name:
            try:
                values.append(float(child.value))
            except ValueError:
                continue
    return values


def _find_joint(compiled: Compiled, model: str, name: str) -> JointBinding | None:
    joints = compiled.names.joints
    return joints.get(f"{model}::{name}") or next((j for n, j in joints.items() if n.endswith("::" + name)), None)


def _check_gains(
    gains: JointGains, joint: JointBinding | None, inertias: _JointInertia, step: float, diagnostics: Diagnostics
) -> None:
    if joint is None or not joint.dofs:
        return
    inertia = inertias.at(joint.dofs[0])
    d_number, p_number = gains.d * step / inertia, gains.p * step**2 / inertia
    if d_number > _RINGING_DAMPING or p_number > _RINGING_STIFFNESS:
        which, value, most = (
            ("d_gain", gains.d, _RINGING_DAMPING * inertia / step)
            if d_number > _RINGING_DAMPING
            else ("p_gain", gains.p, _RINGING_STIFFNESS * inertia / step**2)
        )
        message = (
            f"plugin {gains.plugin!r}: <{which}> {value:g} on joint {joint.scoped!r} with an inertia of {inertia:.3g} "
            f"(kg m2 or kg) oscillates or diverges at a step of {step * 1e3:g} ms"
        )
        diagnostics.warning("SK-LINT-003", message, gains.where, f"use at most {most:.3g}, or a smaller step")


def _check_loads(compiled: Compiled, diagnostics: Diagnostics) -> None:
    """Report contacts in the first state where a heavy body stands on a much lighter one."""
    model = compiled.model
    data = first_state(model)
    mujoco.mj_collision(model, data)
    seen: set[tuple[str, str]] = set()
    for pair in data.contact.geom[: data.ncon]:
        owners = [compiled.names.geom_owner(int(g))[0] for g in pair]
        roots = [int(model.body_rootid[model.geom_bodyid[int(g)]]) for g in pair]
        if roots[0] == roots[1] or any(int(model.body_dofnum[r]) == 0 for r in roots):
            continue
        masses = [float(model.body_subtreemass[r]) for r in roots]
        light, heavy = (0, 1) if masses[0] < masses[1] else (1, 0)
        is_above = data.subtree_com[roots[heavy], 2] > data.subtree_com[roots[light], 2]
        key = (owners[light], owners[heavy])
        if masses[heavy] > LARGEST_LOAD_RATIO * masses[light] and is_above and key not in seen:
            seen.add(key)
            diagnostics.warning(
                "SK-LINT-006",
                f"{owners[heavy]} ({masses[heavy]:.4g} kg) stands on {owners[light]} ({masses[light]:.4g} kg). The "
                f"mass ratio is {masses[heavy] / masses[light]:.0f}. With a ratio above {LARGEST_LOAD_RATIO:g}, the "
                "upper link sinks into the lower link by more than 1 mm",
                compiled.names.link(owners[light]).scene.where,
                "give the lower link more mass",
            )
