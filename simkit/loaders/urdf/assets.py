"""Meshes and textures that a robot names; what is missing is reported once, with every place looked in."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path

from simkit.diagnostics import Diagnostic, Diagnostics
from simkit.loaders.resolver import Resolver
from simkit.params import Params


@dataclass
class Assets:
    """Finds files for one robot.

    Attributes:
        folder: of the robot's file.
    """

    resolver: Resolver
    folder: Path | None
    diagnostics: Diagnostics
    _found: dict[str, Path | None] = field(default_factory=dict)
    _packages: dict[tuple[str, str], list[Diagnostic]] = field(default_factory=dict)

    def mesh(self, uri: str, place: Params, is_visual: bool) -> Path | None:
        """A mesh file.

        A missing one of a collision is an error; of a visual, or where the caller reads on without meshes, a warning.
        """
        soft = is_visual or self.resolver.missing_meshes
        said, path = self._find(f"mesh {soft}", uri, place)
        for problem in said:
            severity = "warning" if soft and problem.severity == "error" else problem.severity
            lost = "; it is not drawn" if is_visual and severity == "warning" else ""
            problem = replace(problem, severity=severity, message=problem.message + lost)
            if problem.code == "SK-URI-009":
                package = uri.partition("://")[2].split("/")[0]
                self._packages.setdefault((package, severity), []).append(problem)
            else:
                self.diagnostics.extend([problem])
        return path

    def texture(self, uri: str, place: Params) -> Path | None:
        """An image file; a missing one is a warning."""
        said, path = self._find("texture", uri, place)
        for problem in said:
            message = f"texture: {problem.message}; drawn without it"
            self.diagnostics.warning("SK-URI-006", message, place.where, problem.hint)
        return path

    def report_packages(self) -> None:
        """Each package that is not here, once, with the lines that need it."""
        for problems in self._packages.values():
            first = problems[0]
            if len(problems) > 1:
                lines = ", ".join(str(p.line) for p in problems[:12]) + (", ..." if len(problems) > 12 else "")
                more = f"; {len(problems)} files of it are needed (lines {lines})"
                first = replace(first, message=first.message + more)
            self.diagnostics.extend([first])

    def _find(self, kind: str, uri: str, place: Params) -> tuple[list[Diagnostic], Path | None]:
        """What a URI names, and what is to be said about it: nothing the second time."""
        key = f"{kind} {uri}"
        if key in self._found:
            return [], self._found[key]
        found = Diagnostics()
        path = self.resolver.resolve(uri, place.where, found, self.folder)
        if path is not None and path.is_dir():
            found.error("SK-URI-001", f"{uri} is a folder ({path}), a file is needed", place.where)
            path = None
        self._found[key] = path if path is None else path.absolute()
        return list(found), self._found[key]
