"""What a xacro file may read: included files, YAML files and packages, all inside the folders of the resolver."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

from simkit.diagnostics import Diagnostics, Where
from simkit.loaders.resources.bounded_file import read_bounded
from simkit.loaders.resources.uri_resolver import Resolver
from simkit.loaders.resources.xml_reader import parse_file
from simkit.loaders.xacro.expansion_limits import MAX_ITEMS, Budget, ExpansionError
from simkit.loaders.xacro.expression import Value
from simkit.params import Params

MAX_YAML_BYTES = 1_000_000
_UNITS = {
    "!radians": 1.0,
    "!degrees": math.pi / 180.0,
    "!meters": 1.0,
    "!millimeters": 0.001,
    "!foot": 0.3048,
    "!inches": 0.0254,
}


class MissingError(ExpansionError):
    """A file that is not there, or may not be read."""

    def __init__(self, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.hint = hint


class FileAccess:
    """Finds and reads files for one expansion.

    Args:
        resolver: knows the folders.
        diagnostics: receives what reading an included file has to say.
        where: gives the place of the element that is being expanded.
    """

    def __init__(self, resolver: Resolver, diagnostics: Diagnostics, where: Callable[[], Where]) -> None:
        self.resolver, self.diagnostics, self._where = resolver, diagnostics, where
        self._packages: dict[str, str] = {}

    def find_file(self, text: str, folder: Path | None) -> Path:
        """The file that a text names, seen from a folder."""
        found = Diagnostics()
        path = self.resolver.resolve(text, self._where(), found, folder)
        if path is not None and path.is_file():
            return path
        said = next(iter(found), None)
        if path is not None:
            raise MissingError(f"{text} is a folder, a file is needed")
        raise MissingError(said.message if said else f"{text} is not found", said.hint if said else "")

    def find_pattern(self, pattern: str, folder: Path | None) -> list[str]:
        """The files that a pattern (`*.xacro`) names, in order."""
        head, _, last = pattern.rpartition("/")
        if any(c in head for c in "*?[") or (folder is None and not head):
            raise MissingError(f"{pattern}: a pattern may be in the file's name only")
        base = folder
        if head:
            base, _ = self.resolver.search(head, folder)
        if base is None or not base.is_dir():
            raise MissingError(f"{pattern}: the folder {head} is not found")
        names = sorted(p for p in base.glob(last) if p.is_file())
        if len(names) > MAX_ITEMS:
            raise MissingError(f"{pattern} names more than {MAX_ITEMS} files")
        return [str(self.find_file(str(name), folder)) for name in names]

    def read_xml(self, path: Path) -> Params:
        """The root element of an included file."""
        found = Diagnostics()
        document = parse_file(path, found)
        self.diagnostics.extend(d for d in found if d.severity != "error")
        if document is None:
            said = next((d for d in found if d.severity == "error"), None)
            place = "" if said is None or said.line is None else f":{said.line}"
            raise ExpansionError(f"{path}{place}: {said.message if said else 'cannot be read'}")
        return document.root

    def package_folder(self, name: str, folder: Path | None) -> str:
        """The folder of a package; where it is not here, `package://name`, with a note, for those who need no file."""
        if name not in self._packages:
            found, tried = self.resolver.find_package(name, folder)
            self._packages[name] = f"package://{name}" if found is None else str(found)
            if found is None:
                places = ", ".join(str(p) for p in tried[:6])
                message = f"$(find {name}): the package is not found, it stands as package://{name}"
                looked = f"; looked in {places}" if places else ""
                hint = f"name its folder: --package-path {name}=DIR"
                self.diagnostics.note("SK-XACRO-007", message + looked, self._where(), hint)
        return self._packages[name]

    def read_yaml(self, path: Path, evaluate: Callable[[str], Value], budget: Budget) -> Value:
        """The content of a YAML file; `!degrees` and the like are understood, aliases are bounded."""
        import yaml

        class Reader(yaml.SafeLoader):
            """Of its own, so that the constructors stay here."""

        def with_unit(factor: float) -> Callable[[Any, Any], float]:
            return lambda loader, node: float(evaluate(str(loader.construct_scalar(node)))) * factor

        for tag, factor in _UNITS.items():
            Reader.add_constructor(tag, with_unit(factor))
        try:
            data = read_bounded(path, MAX_YAML_BYTES)
            if len(data) > MAX_YAML_BYTES:
                raise ExpansionError(f"{path} has more than {MAX_YAML_BYTES} bytes")
            content = yaml.load(data, Reader)
        except OSError as error:
            raise MissingError(f"{path}: {error.strerror}") from None
        except (yaml.YAMLError, ValueError, RecursionError) as error:
            raise ExpansionError(f"{path}: {' '.join(str(error).split())}") from None
        budget.weigh(content)
        return content
