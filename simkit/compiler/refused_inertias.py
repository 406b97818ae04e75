"""Inertias that MuJoCo's compiler refuses: substitutes, limited repairs, and reports about both.

A rigid body's principal moments are positive and A + B >= C (the largest). Files violate this by rounding, by wrong
units, or because their authors never needed it. What counts is the sum of all links of a rigid group (links connected
by fixed joints) about their common centre of mass:

* The sum is valid: nothing is reported. The refused tensor of a link is added to the heaviest link of the group, so
  that the sum stays exact.
* The moments are positive but A + B < C: the engine's equations are valid for such a tensor too, only its compiler
  refuses it. The compiler gets the nearest valid tensor, and after the compile the file's own tensor is restored. The
  motion is therefore that of the file. A shortfall up to `SLIGHT_VIOLATION` of C is reported as a note, else as a
  warning.
* All moments are zero and there are collisions: the group gets the inertia of its collisions at its mass. Gazebo
  Classic takes 1 kg·m² there. Both are stable; with 1 kg·m², small objects turn over in seconds and balls do not roll.
* A moment is zero, or negative by at most `REPAIRABLE_VIOLATION` of the largest: the moment is raised to that of the
  smallest body of the same mass (`LEAST_RADIUS`), and the largest moment stays. A warning contains old and new numbers.
* Any larger violation is an error that contains the moments.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.collision_inertia import collision_inertia
from simkit.diagnostics import Diagnostics
from simkit.float_sum import float_sum
from simkit.linear_algebra import det, matmul
from simkit.matrix_decompositions import eigh
from simkit.scene import Inertial, SceneLink

Matrix = npt.NDArray[np.float64]
Six = tuple[float, float, float, float, float, float]

SLIGHT_VIOLATION: Final = 0.01
"""Largest shortfall of A + B, as a fraction of C, that counts as rounding in the file: a note."""

REPAIRABLE_VIOLATION: Final = 0.01
"""Largest negative moment, as a fraction of the largest moment, that is repaired; a larger one is an error."""

LEAST_RADIUS: Final = 1e-4
"""Radius of gyration [m] of the smallest body that a moment is raised to.

The dynamics of a robot of point masses then change by less than a millionth.
"""

LEAST_MASS: Final = 1e-9
"""Least mass [kg]; MuJoCo moves nothing lighter than 1e-15."""

ENGINE_LEAST_MOMENT: Final = 1e-14
"""Moment of inertia [kg·m²] up to which MuJoCo refuses a body."""

LEAST_MOMENT: Final = 1e-12
"""Least moment of inertia [kg·m²] that simkit uses."""

_NONE: Final[Six] = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
_ROUNDING: Final = 1e-12


@dataclass(frozen=True, slots=True)
class InertiaRepair:
    """Result of checking one mass and tensor.

    Attributes:
        inertial: nearest values that MuJoCo accepts; the same object if it accepts the original.
        verdict: "sound"; "unbalanced": A + B < C; "mended": a moment was raised; "beyond": outside the limits.
        old: original principal moments in rising order [kg·m²].
        new: accepted principal moments in rising order [kg·m²].
        lack: shortfall of A + B as a fraction of C; 0 if A + B >= C.
    """

    inertial: Inertial
    verdict: str
    old: tuple[float, float, float]
    new: tuple[float, float, float]
    lack: float = 0.0

    @property
    def why(self) -> str:
        """Text of the fault with numbers; empty without a fault."""
        moments = format_moments(self.old)
        if self.verdict == "unbalanced":
            return f"principal moments {moments} kg m2: A + B falls short of C by {100 * self.lack:.3g} % of C"
        if self.verdict in ("mended", "beyond"):
            least = "positive" if self.old[0] <= 0 else f"larger than {ENGINE_LEAST_MOMENT:g}"
            return f"principal moments {moments} kg m2: each must be {least}"
        return ""


@dataclass(frozen=True, slots=True)
class BodyInertia:
    """Mass and inertia of a link's body.

    Attributes:
        inertia: tensor for MuJoCo's compiler; all zeros if the tensor was added to another link.
        exact: tensor to set after the compile, in link axes; None if the compiler accepted it.
    """

    mass: float
    com: tuple[float, float, float]
    inertia: Six
    exact: Six | None = None


def repair_inertia(inertial: Inertial, slack: float = 2 * _ROUNDING) -> InertiaRepair:
    """Check a mass and tensor, and return the nearest valid ones.

    The nearest tensor with A + B >= C changes each moment by a third of the shortfall (least squares). If a moment is
    not positive, small moments are raised to `LEAST_RADIUS`² · mass and further until A + B >= C. The largest moment
    stays.

    Args:
        inertial: mass and tensor.
        slack: excess of A + B over C in a repaired tensor, as a fraction of C.
    """
    if not any(inertial.inertia[3:]):  # fast path: most tensors are diagonal and need no eigenvalues
        a, b, c = sorted(float(v) for v in inertial.inertia[:3])
        if a > ENGINE_LEAST_MOMENT and c - b - a <= -_ROUNDING * c:
            return InertiaRepair(inertial, "sound", (a, b, c), (a, b, c))
    values, axes = eigh(inertia_matrix(inertial.inertia))
    old = _as_vector(values)
    floor = max(LEAST_MOMENT, LEAST_RADIUS**2 * inertial.mass)
    lack = float(values[2] - values[1] - values[0])
    part = max(0.0, lack / float(values[2])) if values[2] > 0 else 0.0
    if values[0] > ENGINE_LEAST_MOMENT and values[0] > -_ROUNDING * values[2]:
        if lack <= -_ROUNDING * values[2]:
            return InertiaRepair(inertial, "sound", old, old)
        new = values + (lack + slack * values[2]) / 3.0 * np.array((1.0, 1.0, -1.0))
        verdict = "unbalanced" if part > 1e-9 else "sound"
        return InertiaRepair(_with_inertial(inertial, new, axes), verdict, old, _as_vector(new), part)
    verdict = "mended" if values[0] >= -REPAIRABLE_VIOLATION * max(float(values[2]), floor) else "beyond"
    new = np.maximum(values, floor)
    missing = float(new[2] - new[1] - new[0])
    if missing > 0:
        new[:2] += (missing + slack * float(new[2])) / 2.0
    return InertiaRepair(_with_inertial(inertial, new, axes), verdict, old, _as_vector(new), part)


def is_point(repair: InertiaRepair) -> bool:
    """Check whether a repaired inertia is that of a point: no moment is larger than that of the smallest body."""
    return repair.verdict == "mended" and repair.old[2] <= max(LEAST_MOMENT, LEAST_RADIUS**2 * repair.inertial.mass)


def plan_inertials(
    links: Sequence[SceneLink], rigid: Mapping[str, str], still: frozenset[str], diagnostics: Diagnostics
) -> dict[str, BodyInertia]:
    """Return a mass and an inertia for each link's body that MuJoCo accepts.

    The sum of each rigid group that moves stays that of the file.

    Args:
        links: moving links.
        rigid: scoped name of the first link of the rigid group, by scoped name of the link.
        still: scoped names of the first links of rigid groups that cannot move.
        diagnostics: collection for one message about each invalid sum.
    """
    groups: dict[str, list[SceneLink]] = {}
    for link in links:
        groups.setdefault(rigid.get(link.scoped, link.scoped), []).append(link)
    written: dict[str, BodyInertia] = {}
    for foot, members in groups.items():
        members.sort(key=lambda link: link.scoped != foot)
        if not all(_is_finite(link.inertial) for link in members):
            written |= {link.scoped: _file_inertia(Inertial()) for link in members}
            for link in members:
                if not _is_finite(link.inertial):
                    text = f"link {link.scoped}: mass, centre of mass or inertia is NaN or infinite"
                    diagnostics.error("SK-PHYS-018", text, link.where)
        else:
            written |= _rigid_groups(members, foot not in still, diagnostics)
    return written


def _rigid_groups(members: list[SceneLink], moves: bool, diagnostics: Diagnostics) -> dict[str, BodyInertia]:
    """Return the inertias of one rigid group; the first link of the group is first in `members`."""
    if moves and float_sum(m.inertial.mass for m in members) < LEAST_MASS:
        return _with_some_mass(members, diagnostics)
    judged = {link.scoped: repair_inertia(link.inertial) for link in members}
    refused = [m for m in members if judged[m.scoped].inertial is not m.inertial]
    if not refused:
        return {m.scoped: _file_inertia(m.inertial) for m in members}
    if not any(judged[m.scoped].verdict != "sound" for m in refused):
        return {m.scoped: _file_inertia(judged[m.scoped].inertial) for m in members}
    if moves and len(members) > 1:
        handed = _move_to_heaviest(members, refused)
        if handed is not None:
            return handed
    if not moves:
        return {m.scoped: _file_inertia(judged[m.scoped].inertial if m in refused else m.inertial) for m in members}
    return _substitute_inertias(members, judged, diagnostics)


def _with_some_mass(members: list[SceneLink], diagnostics: Diagnostics) -> dict[str, BodyInertia]:
    """Return the inertias of links with an inertia but without mass; the first link gets the least mass."""
    foot = members[0]
    if foot.inertial.mass >= 0.0:  # a negative mass is an error of the file
        message = f"link {foot.scoped}: {foot.inertial.mass:g} kg is too light to move; {LEAST_MASS:g} kg are used"
        diagnostics.warning("SK-PHYS-011", message, foot.where, "give the link its mass")
    written = {m.scoped: _file_inertia(repair_inertia(m.inertial).inertial) for m in members}
    inertia = written[foot.scoped]
    written[foot.scoped] = BodyInertia(LEAST_MASS, inertia.com, inertia.inertia, inertia.exact)
    return written


def _move_to_heaviest(members: list[SceneLink], refused: list[SceneLink]) -> dict[str, BodyInertia] | None:
    """Add the refused tensors to that of the heaviest member; None if the sum is refused as well."""
    target = max(members, key=lambda m: (m.inertial.mass, m is members[0]))
    sources = [m for m in refused if m is not target]
    inertia = inertia_matrix(target.inertial.inertia)
    for source in sources:
        inertia = inertia + _rotate_tensor(target, source, inertia_matrix(source.inertial.inertia))
    total = repair_inertia(_replace_inertials(target.inertial, inertia))
    if total.verdict != "sound":
        return None
    written = {m.scoped: _file_inertia(m.inertial) for m in members}
    written |= {m.scoped: BodyInertia(m.inertial.mass, m.inertial.com, _NONE) for m in sources}
    written[target.scoped] = _file_inertia(total.inertial)
    return written


def _substitute_inertias(
    members: list[SceneLink], judged: Mapping[str, InertiaRepair], diagnostics: Diagnostics
) -> dict[str, BodyInertia]:
    """Return substitutes for the compiler and the file's own tensors for the engine; report an invalid sum."""
    foot = members[0]
    mass, tensor = rigid_sum(members)
    total = repair_inertia(Inertial(mass, (0.0, 0.0, 0.0), inertia_moments(tensor)))
    written = {}
    for m in members:
        original, substitute = m.inertial, judged[m.scoped].inertial
        exact = None if substitute is original or judged[m.scoped].verdict == "sound" else original.inertia
        written[m.scoped] = BodyInertia(substitute.mass, substitute.com, substitute.inertia, exact)
    others = [m.name for m in members[1:]]
    owner = f"link {foot.scoped}" + (f" (with {', '.join(others)}, fixed to it)" if others else "")
    hint = "simkit check --fix-inertia prints valid numbers"
    if mass <= 0:
        return written  # `ModelWriter` reports links without mass
    if total.verdict == "unbalanced":
        report = diagnostics.note if total.lack <= SLIGHT_VIOLATION else diagnostics.warning
        text = f"{owner}: {total.why}; no rigid body has such moments, they are simulated as written"
        report("SK-INERTIA-001", text, foot.where, hint)
    elif total.verdict == "mended":
        new = collision_inertia(members, mass, diagnostics) if is_point(total) else None
        extra = (inertia_matrix(total.inertial.inertia) if new is None else new) - tensor
        inertial = judged[foot.scoped].inertial
        exact = inertia_moments(inertia_matrix(foot.inertial.inertia) + _rotate_from_world(foot, extra))
        valid = Inertial(inertial.mass, inertial.com, exact)
        if repair_inertia(valid).inertial is valid:
            written[foot.scoped] = _file_inertia(valid)
        else:
            written[foot.scoped] = BodyInertia(inertial.mass, inertial.com, inertial.inertia, exact)
        used = total.new if new is None else _as_vector(eigh(new)[0])
        source = "" if new is None else f", which are those of its collisions at {mass:g} kg"
        text = f"{owner}: {total.why}; {format_moments(used)} are used{source}"
        diagnostics.warning("SK-PHYS-011", text, foot.where, hint)
    elif total.verdict == "beyond":
        text = f"{owner} of {mass:g} kg: {total.why}; the error is too large{_likely_cause(foot.inertial, total)}"
        diagnostics.error("SK-INERTIA-002", text, foot.where, hint)
    return written


def _likely_cause(inertial: Inertial, repair: InertiaRepair) -> str:
    """Return the most frequent cause of such numbers as a hint in the message."""
    i = inertial.inertia
    if min(i[:3]) > 0 and repair.old[0] < 0:
        return "; the products of inertia (ixy, ixz, iyz) are too large: check their signs and units"
    if repair.old[2] <= 0:
        return "; all moments are negative: check their signs"
    return "; check the signs on the diagonal"


def restore_file_inertias(model: mujoco.MjModel, exact: Mapping[str, tuple[float, Six]]) -> None:
    """Set the file's inertia tensors, which the compiler refused, on the bodies of a compiled model.

    Args:
        model: MuJoCo's model.
        exact: mass [kg] in the specification and tensor [kg·m², link axes] of the file, by body. The tensor is scaled
            if a twin has received a fraction of the body's mass.
    """
    if not exact:
        return
    for name, (mass, six) in exact.items():
        body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name)
        share = float(model.body_mass[body]) / mass if mass > 0 else 1.0
        values, axes = eigh(inertia_matrix(six))
        if det(axes) < 0:
            axes[:, 0] = -axes[:, 0]
        quaternion = np.empty(4)
        mujoco.mju_mat2Quat(quaternion, axes.reshape(-1))
        model.body_inertia[body] = share * values
        model.body_iquat[body] = quaternion
    mujoco.mj_setConst(model, mujoco.MjData(model))


def rigid_sum(links: Sequence[SceneLink]) -> tuple[float, Matrix]:
    """Return mass [kg] and tensor [kg·m²] of a rigid group of links, about its centre of mass, in world axes."""
    mass = float_sum(m.inertial.mass for m in links)
    centres = [m.pose_world.transform(m.inertial.com) for m in links]
    middle = (
        sum((m.inertial.mass * c for m, c in zip(links, centres, strict=True)), np.zeros(3)) / mass
        if mass > 0
        else centres[0]
    )
    total = np.zeros((3, 3))
    for m, centre in zip(links, centres, strict=True):
        turn, d = m.pose_world.matrix, centre - middle
        total += matmul(turn, inertia_matrix(m.inertial.inertia), turn.T)
        total += m.inertial.mass * (float(matmul(d, d)) * np.eye(3) - np.outer(d, d))
    return mass, total


def inertia_matrix(v: Sequence[float]) -> Matrix:
    """Return the symmetric matrix with the elements ixx, iyy, izz, ixy, ixz, iyz."""
    return np.array(((v[0], v[3], v[4]), (v[3], v[1], v[5]), (v[4], v[5], v[2])))


def inertia_moments(m: Matrix) -> Six:
    """Return the elements ixx, iyy, izz, ixy, ixz, iyz of a symmetric matrix."""
    return float(m[0, 0]), float(m[1, 1]), float(m[2, 2]), float(m[0, 1]), float(m[0, 2]), float(m[1, 2])


def format_moments(values: Sequence[float]) -> str:
    """Format moments as `(1.8e-05, 0.000223, 0.000244)`."""
    return "(" + ", ".join(f"{v:.4g}" for v in values) + ")"


def _file_inertia(inertial: Inertial) -> BodyInertia:
    return BodyInertia(inertial.mass, inertial.com, inertial.inertia)


def _rotate_tensor(target: SceneLink, source: SceneLink, tensor: Matrix) -> Matrix:
    """Rotate a tensor from the axes of one link to those of another."""
    turn = matmul(target.pose_world.matrix.T, source.pose_world.matrix)
    turned: Matrix = matmul(turn, tensor, turn.T)
    return turned


def _rotate_from_world(link: SceneLink, tensor: Matrix) -> Matrix:
    """Rotate a tensor from world axes to those of a link."""
    turn = link.pose_world.matrix
    turned: Matrix = matmul(turn.T, tensor, turn)
    return turned


def _with_inertial(inertial: Inertial, moments: Matrix, axes: Matrix) -> Inertial:
    return _replace_inertials(inertial, matmul(axes * moments, axes.T))


def _replace_inertials(inertial: Inertial, tensor: Matrix) -> Inertial:
    return Inertial(inertial.mass, inertial.com, inertia_moments(tensor), inertial.given)


def _as_vector(values: Matrix) -> tuple[float, float, float]:
    return float(values[0]), float(values[1]), float(values[2])


def _is_finite(inertial: Inertial) -> bool:
    return all(map(math.isfinite, (inertial.mass, *inertial.com, *inertial.inertia)))
