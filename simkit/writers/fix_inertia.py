"""Corrections of impossible inertias, and the file with corrected values (`simkit check --fix-inertia`)."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from simkit.compiler.collision_inertia import collision_inertia
from simkit.compiler.mjcf_parser import MjcfParser
from simkit.compiler.refused_inertias import InertiaRepair, format_moments, inertia_moments, is_point, repair_inertia
from simkit.diagnostics import Diagnostics
from simkit.errors import InputError
from simkit.linear_algebra import matmul
from simkit.loaders import Resolver, load_scene
from simkit.loaders.inertia_text import WrittenInertia, find_inertias, replace_numbers
from simkit.loaders.sdf.inertial import MOMENT_NAMES
from simkit.run_files import FilePath
from simkit.scene import Inertial, Scene, SceneLink

_SLACK = 1e-6  # relative to the largest moment; tolerance for rounded values in files


@dataclass(frozen=True, slots=True)
class InertiaFix:
    """Corrected inertia of one link.

    Attributes:
        file, line: location of its `<inertia>`.
        old, new: principal moments [kg·m²].
        numbers: changed values among ixx, iyy, izz, ixy, ixz, iyz, as text, in the axes of the file.
        why: problem of the old values.
    """

    file: Path
    line: int
    link: str
    mass: float
    old: tuple[float, float, float]
    new: tuple[float, float, float]
    numbers: dict[str, str]
    before: dict[str, float]
    why: str

    def __str__(self) -> str:
        changed = ", ".join(f"{k} {self.before[k]:g} -> {v}" for k, v in self.numbers.items())
        moments = f"moments {format_moments(self.old)} -> {format_moments(self.new)}"
        return f"{self.file}:{self.line}: link {self.link!r} ({self.mass:g} kg): {changed}\n    {moments}: {self.why}"


@dataclass(frozen=True, slots=True)
class InertiaFixes:
    """Corrections for the impossible inertias of a file and of its included files.

    Attributes:
        source: checked file.
        problems: files that could not be checked, with the reason.
    """

    source: Path
    fixes: tuple[InertiaFix, ...]
    problems: tuple[str, ...] = ()

    @property
    def elsewhere(self) -> tuple[InertiaFix, ...]:
        """Corrections in files that the source includes."""
        return tuple(f for f in self.fixes if f.file.resolve() != self.source.resolve())

    def write(self, target: Path) -> int:
        """Write the source with corrected values and all other bytes unchanged; return the number of changed links.

        The file is first written under a temporary name, so an error leaves no incomplete file.

        Raises:
            InputError: SK-CLI-016 the file is not writable.
        """
        numbers_by_link = {(f.link, f.line): f.numbers for f in self.fixes if f not in self.elsewhere}
        data, inertias = find_inertias(self.source)
        changes = [(i, numbers_by_link[i.link, i.line]) for i in inertias if (i.link, i.line) in numbers_by_link]
        temporary = target.with_name(f".{target.name}.part")
        try:
            temporary.write_bytes(replace_numbers(data, changes))
            os.replace(temporary, target)  # noqa: PTH105 - atomic on every platform
        except OSError as error:
            temporary.unlink(missing_ok=True)
            raise InputError("SK-CLI-016", f"cannot write {target}: {error.strerror or error}") from None
        return len(changes)


def find_inertia_fixes(source: Path, resource_paths: Sequence[FilePath] = ()) -> InertiaFixes:
    """Find all impossible inertias in a file and in its included files.

    Raises:
        InputError: SK-LOAD-002 the file does not exist.
        LoadError: a number cannot be read, or is NaN or infinite.
    """
    resolver = Resolver(list(resource_paths), missing_meshes=True)
    diagnostics = Diagnostics()
    scene = load_scene(source, resolver=resolver, diagnostics=diagnostics, mjcf_parser=MjcfParser)
    path = Path(scene.file or source)
    if not path.is_file():
        diagnostics.raise_if_errors()
        raise InputError("SK-LOAD-002", f"{source} is not a file")
    fixes: list[InertiaFix] = []
    problems: list[str] = []
    links = _scene_links(scene)
    by_place = {(Path(link.where.file).resolve(), link.name): link for link in links if link.where.file}
    for file in dict.fromkeys([path, *_link_files(links)]):
        if file.suffix == ".xacro":
            problems.append(f"{file}: xacro files compute their values; correct the expanded file")
            continue
        try:
            _, inertias = find_inertias(file)
        except (OSError, ValueError) as error:
            diagnostics.raise_if_errors()  # they name the line of the number
            problems.append(f"{file}: {error}")
            continue
        for inertia in inertias:
            if not all(map(math.isfinite, (inertia.mass, *inertia.moments))):
                diagnostics.raise_if_errors()
                continue  # of a static model, where it has no effect
            fix = _fix_inertia(file, inertia, by_place.get((file.resolve(), inertia.link)))
            fixes += [fix] if fix is not None else []
    return InertiaFixes(path, tuple(fixes), tuple(problems))


def _scene_links(scene: Scene) -> list[SceneLink]:
    tops = [m for w in scene.worlds for m in w.models] + ([scene.model] if scene.model is not None else [])
    return [link for top in tops for link in top.all_links()]


def _link_files(links: Sequence[SceneLink]) -> list[Path]:
    """Return the files that links come from."""
    named = {link.where.file for link in links if link.where.file}
    return [path for name in sorted(named) if (path := Path(name)).is_file()]


def _fix_inertia(file: Path, inertia: WrittenInertia, link: SceneLink | None) -> InertiaFix | None:
    """Return the correction of an inertia; None if it is valid, or if the link has no mass.

    Args:
        file: file of the inertia.
        inertia: inertia as written.
        link: link of the inertia, whose collisions give the numbers if all moments are zero; None if it is not known.
    """
    original = Inertial(inertia.mass, (0.0, 0.0, 0.0), inertia.moments)
    if inertia.mass <= 0:
        return None
    repair = repair_inertia(original, slack=_SLACK)
    if repair.verdict == "sound":
        return None
    if is_point(repair) and link is not None:
        repair = _from_collisions(repair, inertia, link)
    new = dict(zip(MOMENT_NAMES, repair.inertial.inertia, strict=True))
    size = max(abs(v) for v in new.values())
    texts = {k: f"{v:.9g}" if abs(v) > 1e-9 * size else "0" for k, v in new.items()}
    changed = {k: t for k, t in texts.items() if abs(float(t) - inertia.values[k]) > 1e-9 * size}
    return InertiaFix(
        file, inertia.line, inertia.link, inertia.mass, repair.old, repair.new, changed, inertia.values, repair.why
    )


def _from_collisions(repair: InertiaRepair, inertia: WrittenInertia, link: SceneLink) -> InertiaRepair:
    """Return the repair with the inertia of the link's collisions; unchanged if they have no volume.

    If the axes of the inertia are rotated, all moments are the mean, which is the same in all axes.
    """
    tensor = collision_inertia([link], inertia.mass, Diagnostics())
    if tensor is None:
        return repair
    turn = link.pose_world.matrix
    tensor = matmul(turn.T, tensor, turn)
    if inertia.is_rotated:
        tensor = np.eye(3) * (np.trace(tensor) / 3.0)
    of_shapes = repair_inertia(Inertial(inertia.mass, (0.0, 0.0, 0.0), inertia_moments(tensor)), slack=_SLACK)
    return replace(repair, inertial=of_shapes.inertial, new=of_shapes.new)
