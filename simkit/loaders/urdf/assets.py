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
    _packages: dict[str, list[Diagnostic]] = field(default_factory=dict)

    def mesh(self, uri: str, place: Params) -> Path | None:
        """A mesh file; one that is missing is a warning."""
        if uri in self._found:
            return self._found[uri]
        path, said = self.resolver.mesh(uri, place.where, self.folder)
        self._found[uri] = path = path if path is None else path.absolute()
        for problem in said:
            if problem.code == "SK-URI-009":
                package = uri.partition("://")[2].split("/")[0]
                self._packages.setdefault(package, []).append(problem)
            else:
                self.diagnostics.extend([problem])
        return path

    def texture(self, uri: str, place: Params) -> Path | None:
        """An image file; a missing one is a warning."""
        key = f"texture {uri}"
        if key not in self._found:
            found = Diagnostics()
            path = self.resolver.resolve(uri, place.where, found, self.folder)
            self._found[key] = path if path is None else path.absolute()
            for problem in found:
                message = f"texture: {problem.message}; drawn without it"
                self.diagnostics.warning("SK-URI-006", message, place.where, problem.hint)
        return self._found[key]

    def report_packages(self) -> None:
        """Each package that is not here, once, with the lines that need it."""
        for problems in self._packages.values():
            first = problems[0]
            if len(problems) > 1:
                lines = ", ".join(str(p.line) for p in problems[:12]) + (", ..." if len(problems) > 12 else "")
                more = f"; {len(problems)} files of it are needed (lines {lines})"
                first = replace(first, message=first.message + more)
            self.diagnostics.extend([first])
