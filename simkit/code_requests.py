"""Code that a file which describes a run asks for, and the refusal to run it without a permission.

A scenario, golden run, exercise or sweep only asks for code. The person who runs it allows the code, with an option or
an argument: `simkit.testing.scenarios.code_permission`.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from simkit.diagnostic_record import Diagnostic, Where
from simkit.errors import LoadError
from simkit.run_files import FileName
from simkit.run_nodes import Node, node_arguments

CODE_REFUSED: Final = "SK-SCEN-008"


@dataclass(frozen=True)
class CodeRequest:
    """Code that a file asks for.

    Attributes:
        words: subject and verb of a message, such as `plugin_paths names '.'`.
        path: folder of plugins or Python file; None for a function of an installed module.
        where: position in the file that asks.
        is_folder: True for a folder of plugins.
    """

    words: str
    path: Path | None
    where: Where
    is_folder: bool = False

    def is_within(self, folders: Sequence[str | os.PathLike[str]]) -> bool:
        """Check whether the code is in one of some folders; symbolic links are followed."""
        if self.path is None:
            return False
        try:
            place = self.path.resolve()
            return any(place.is_relative_to(Path(folder).resolve()) for folder in folders)
        except (OSError, ValueError, RuntimeError):  # a circle of links, or a character that no path has
            return False

    def diagnostic(self) -> Diagnostic:
        """Return the refusal of this code."""
        hint = "read the code first; then allow it with --allow-code (Python: allow_code=True)"
        if self.path is not None:
            folder = self.path if self.is_folder else self.path.parent
            shown = min(_relative(folder), str(folder.absolute()), key=len)
            hint = f"read the code first; then allow it with --plugin-path {shown} (this folder only) or --allow-code"
            hint += " (Python: allow_code=True)"
        message = f"{self.words}, and code of a file runs only with your permission"
        return Diagnostic(CODE_REFUSED, "error", message, self.where.file, self.where.line, hint)


def folder_request(text: str, folder: Path, where: Where) -> CodeRequest:
    """Return the request for a folder of plugins.

    Args:
        text: folder as written in the file.
        folder: folder.
        where: position in the file.
    """
    return CodeRequest(f"plugin_paths names {text!r:.200}", folder, where, is_folder=True)


def node_requests(nodes: Sequence[Node], folder: Path, where: Callable[[int], Where]) -> tuple[CodeRequest, ...]:
    """Return the requests for the programs of nodes.

    Args:
        nodes: nodes.
        folder: folder of the file; an executable of a package has no path here.
        where: function that returns the position of a node, by its number, in the file.
    """
    requests = []
    for number, node in enumerate(nodes):
        name = FileName(node_arguments(node)["program"], "program", ("nodes", number))
        words = f"nodes names the program {name.text!r:.200}"
        requests.append(CodeRequest(words, name.used_path(folder), where(number)))
    return tuple(requests)


def code_refusal(requests: Sequence[CodeRequest]) -> LoadError:
    """Return the error for code that the user has not allowed; it lists all of it."""
    return LoadError([request.diagnostic() for request in requests])


def _relative(folder: Path) -> str:
    """Return a folder relative to the working directory; the absolute path if the two are on different drives."""
    try:
        return os.path.relpath(folder)
    except ValueError:
        return str(folder.absolute())
