"""Find inertias that no solid has, and write the file with repaired numbers (`simkit check --fix-inertia`)."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from simkit.compiler.mjcf_parser import MjcfParser
from simkit.compiler.refused_inertias import format_moments, repair_inertia
from simkit.diagnostics import Diagnostics
from simkit.errors import InputError
from simkit.loaders import Resolver, load_scene
from simkit.loaders.inertia_text import MOMENT_NAMES, WrittenInertia, find_inertias, replace_numbers
from simkit.scene import Inertial, Scene

_SLACK = 1e-6  # of the largest moment: room for the digits that a file is written with


@dataclass(frozen=True, slots=True)
class InertiaFix:
    """New numbers for one link.

    Attributes:
        file, line: where its `<inertia>` stands.
        old, new: principal moments [kg·m²].
        numbers: the changed ones of ixx, iyy, izz, ixy, ixz, iyz, as they are written, in the file's axes.
        why: what is wrong with the old ones.
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
    """Inertias of a file, and of the files it includes, that need other numbers.

    Attributes:
        source: the file that was asked about.
        problems: files that could not be looked into, with the reason.
    """

    source: Path
    fixes: tuple[InertiaFix, ...]
    problems: tuple[str, ...] = ()

    @property
    def elsewhere(self) -> tuple[InertiaFix, ...]:
        """Fixes in files that the source includes."""
        return tuple(f for f in self.fixes if f.file.resolve() != self.source.resolve())

    def write(self, target: Path) -> int:
        """Writes the source with the new numbers and every other byte as it is; returns how many links it changed.

        The file is complete before it gets its name.

        Raises:
            InputError: SK-CLI-016 it cannot be written.
        """
        wanted = {(f.link, f.line): f.numbers for f in self.fixes if f not in self.elsewhere}
        data, inertias = find_inertias(self.source)
        changes = [(i, wanted[i.link, i.line]) for i in inertias if (i.link, i.line) in wanted]
        temporary = target.with_name(f".{target.name}.part")
        try:
            temporary.write_bytes(replace_numbers(data, changes))
            os.replace(temporary, target)  # noqa: PTH105 - atomic on every platform
        except OSError as error:
            temporary.unlink(missing_ok=True)
            raise InputError(f"SK-CLI-016 cannot write {target}: {error.strerror or error}", "SK-CLI-016") from None
        return len(changes)


def find_inertia_fixes(source: Path, resource_paths: Sequence[Path] = ()) -> InertiaFixes:
    """Every inertia that no solid has, in a file and in what it includes.

    Raises:
        InputError: SK-LOAD-002 no such file.
    """
    resolver = Resolver(list(resource_paths), missing_meshes=True)
    diagnostics = Diagnostics()
    scene = load_scene(source, resolver=resolver, diagnostics=diagnostics, mjcf_parser=MjcfParser)
    path = Path(scene.file or source)
    if not path.is_file():
        diagnostics.raise_if_errors()
        raise InputError(f"SK-LOAD-002 {source} is no file", "SK-LOAD-002")
    fixes: list[InertiaFix] = []
    problems: list[str] = []
    for file in dict.fromkeys([path, *_scene_files(scene)]):
        if file.suffix == ".xacro":
            problems.append(f"{file}: the numbers of a xacro file are made when it is expanded; fix the expanded file")
            continue
        try:
            _, inertias = find_inertias(file)
        except (OSError, ValueError) as error:
            problems.append(f"{file}: {error}")
            continue
        fixes += [fix for inertia in inertias if (fix := _fix_inertia(file, inertia)) is not None]
    return InertiaFixes(path, tuple(fixes), tuple(problems))


def _scene_files(scene: Scene) -> list[Path]:
    """The files that the scene's links were read from."""
    tops = [m for w in scene.worlds for m in w.models] + ([scene.model] if scene.model is not None else [])
    named = {link.where.file for top in tops for link in top.all_links() if link.where.file}
    return [path for name in sorted(named) if (path := Path(name)).is_file()]


def _fix_inertia(file: Path, inertia: WrittenInertia) -> InertiaFix | None:
    """New numbers for an inertia; None where it is sound, or the link has no mass and is but a frame."""
    given = Inertial(inertia.mass, (0.0, 0.0, 0.0), inertia.six)
    if inertia.mass <= 0:
        return None
    found = repair_inertia(given, slack=_SLACK)
    if found.verdict == "sound":
        return None
    new = dict(zip(MOMENT_NAMES, found.inertial.inertia, strict=True))
    size = max(abs(v) for v in new.values())
    texts = {k: f"{v:.9g}" if abs(v) > 1e-9 * size else "0" for k, v in new.items()}
    changed = {k: t for k, t in texts.items() if abs(float(t) - inertia.values[k]) > 1e-9 * size}
    return InertiaFix(
        file, inertia.line, inertia.link, inertia.mass, found.old, found.new, changed, inertia.values, found.why
    )
