"""File access of a xacro file: included files, YAML files and packages, all inside the resolver's folders."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

from simkit.diagnostics import Diagnostics, Where
from simkit.input_file import FileTooLargeError, read_input
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
    """File that does not exist or may not be read."""

    def __init__(self, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.hint = hint


class FileAccess:
    """Finder and reader of files for one expansion.

    Args:
        resolver: finds files and packages.
        diagnostics: receives the problems of included files.
        where: returns the place of the element that is being expanded.
    """

    def __init__(self, resolver: Resolver, diagnostics: Diagnostics, where: Callable[[], Where]) -> None:
        self.resolver, self.diagnostics, self._where = resolver, diagnostics, where
        self._packages: dict[str, str] = {}

    def find_file(self, text: str, folder: Path | None) -> Path:
        """Return the file that a text names, relative to a folder.

        Raises:
            MissingError: there is no such file.
        """
        problems = Diagnostics()
        path = self.resolver.resolve(text, self._where(), problems, folder)
        if path is not None and path.is_file():
            return path
        problem = next(iter(problems), None)
        if path is not None:
            raise MissingError(f"{text} is a folder, not a file")
        raise MissingError(problem.message if problem else f"{text} is not found", problem.hint if problem else "")

    def find_pattern(self, pattern: str, folder: Path | None) -> list[str]:
        """Return the files that a pattern (`*.xacro`) matches, sorted.

        Raises:
            MissingError: the folder does not exist, or the pattern is not allowed.
        """
        head, _, last = pattern.rpartition("/")
        if any(c in head for c in "*?[") or (folder is None and not head):
            raise MissingError(f"{pattern}: wildcards are only allowed in the file's name")
        base = folder
        if head:
            base, _ = self.resolver.search(head, folder)
        if base is None or not base.is_dir():
            raise MissingError(f"{pattern}: the folder {head} is not found")
        names = sorted(p for p in base.glob(last) if p.is_file())
        if len(names) > MAX_ITEMS:
            raise MissingError(f"{pattern} matches more than {MAX_ITEMS} files")
        return [str(self.find_file(str(name), folder)) for name in names]

    def read_xml(self, path: Path) -> Params:
        """Return the root element of an included file.

        Raises:
            ExpansionError: the file cannot be read.
        """
        problems = Diagnostics()
        document = parse_file(path, problems)
        self.diagnostics.extend(d for d in problems if d.severity != "error")
        if document is None:
            problem = next((d for d in problems if d.severity == "error"), None)
            line = "" if problem is None or problem.line is None else f":{problem.line}"
            raise ExpansionError(f"{path}{line}: {problem.message if problem else 'cannot be read'}")
        return document.root

    def package_folder(self, name: str, folder: Path | None) -> str:
        """Return the folder of a package, or `package://name` with a note if the package is not found.

        A robot that opens no file of the package can then still be loaded.
        """
        if name not in self._packages:
            package_place, tried = self.resolver.find_package(name, folder)
            self._packages[name] = f"package://{name}" if package_place is None else str(package_place)
            if package_place is None:
                message = f"$(find {name}): the package is not found; package://{name} is used"
                searched = self.resolver.format_searched_packages(tried, folder)
                hint = f"give its folder, --package-path {name}=DIR, or its workspace, --package-path DIR"
                self.diagnostics.note("SK-XACRO-007", message + searched, self._where(), hint)
        return self._packages[name]

    def read_yaml(self, path: Path, evaluate: Callable[[str], Value], budget: Budget) -> Value:
        """Return the content of a YAML file; units such as `!degrees` are converted, and aliases are limited.

        Raises:
            MissingError: the file cannot be opened.
            ExpansionError: the file is invalid or too large.
        """
        import yaml

        class Reader(yaml.SafeLoader):
            """Separate class, so that the added constructors do not change `yaml.SafeLoader`."""

        def with_unit(factor: float) -> Callable[[yaml.SafeLoader, yaml.ScalarNode], float]:
            return lambda loader, node: float(evaluate(str(loader.construct_scalar(node)))) * factor

        for tag, factor in _UNITS.items():
            Reader.add_constructor(tag, with_unit(factor))
        try:
            content = yaml.load(read_input(path, MAX_YAML_BYTES), Reader)
        except FileTooLargeError as error:
            raise ExpansionError(f"{path}: {error.strerror}") from None
        except OSError as error:
            raise MissingError(f"{path}: {error.strerror}") from None
        except (yaml.YAMLError, ValueError, RecursionError) as error:
            raise ExpansionError(f"{path}: {' '.join(str(error).split())}") from None
        budget.weigh(content)
        return content
