"""Commands of a package's `CMakeLists.txt`, read without running CMake."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Final, NamedTuple

from simkit.input_file import read_input

_LARGEST: Final = 1_000_000  # [bytes]
_COMMENT: Final = re.compile(r'("(?:[^"\\]|\\.)*")|#\[\[.*?\]\]|#[^\n]*', re.DOTALL)
_COMMAND: Final = re.compile(r"([A-Za-z_]\w*)\s*\(((?:[^()\"]|\"(?:[^\"\\]|\\.)*\"|\([^()]*\))*)\)")
_WORD: Final = re.compile(r'"((?:[^"\\]|\\.)*)"|([^\s;"]+)')
_VARIABLE: Final = re.compile(r"\$\{(\w+)\}")
_DEEPEST: Final = 10  # variables in variables


class Command(NamedTuple):
    """Command of a CMake file.

    Attributes:
        name: name in lower case.
        words: arguments without quotation marks; variables are replaced, a list gives several words.
    """

    name: str
    words: list[str]

    def after(self, keyword: str, *ends: str) -> list[str]:
        """Return the words from a keyword on, up to one of other keywords."""
        if keyword not in self.words:
            return []
        rest = self.words[self.words.index(keyword) + 1 :]
        last = next((index for index, word in enumerate(rest) if word in ends), len(rest))
        return rest[:last]


def cmake_commands(package: Path, name: str) -> list[Command]:
    """Return the commands of a package's `CMakeLists.txt`, in their order; both branches of a condition count.

    A variable of a loop stands for all its values.

    Args:
        package: folder of the package.
        name: name of the package.
    """
    try:
        text = read_input(package / "CMakeLists.txt", _LARGEST, inside=package).decode(errors="replace")
    except OSError:
        return []
    text = _COMMENT.sub(lambda match: match[1] or " ", text)
    variables = _common_variables(package, name)
    commands = []
    for match in _COMMAND.finditer(text):
        command = Command(match[1].lower(), list(_words(match[2], variables)))
        words = command.words
        if command.name == "project" and words:
            variables["PROJECT_NAME"] = words[:1]
        elif command.name in ("set", "foreach") and words:
            variables[words[0]] = [word for word in words[1:] if word not in ("IN", "LISTS", "ITEMS", "PARENT_SCOPE")]
            for word in command.after("LISTS", "ITEMS"):
                variables[words[0]] += variables.get(word, [])
        elif command.name == "list" and words[:1] == ["APPEND"]:
            variables.setdefault(words[1], []).extend(words[2:])
        elif command.name == "file" and words and words[0] in ("GLOB", "GLOB_RECURSE") and len(words) > 1:
            variables[words[1]] = _matching_files(package, words[2:])
        commands.append(command)
    return commands


def _common_variables(package: Path, name: str) -> dict[str, list[str]]:
    programs, share = [f"lib/{name}"], [f"share/{name}"]
    return {
        "PROJECT_NAME": [name],
        "CMAKE_CURRENT_SOURCE_DIR": [str(package)],
        "CMAKE_CURRENT_LIST_DIR": [str(package)],
        "CMAKE_SOURCE_DIR": [str(package)],
        "PROJECT_SOURCE_DIR": [str(package)],
        "CATKIN_PACKAGE_BIN_DESTINATION": programs,
        "CATKIN_GLOBAL_BIN_DESTINATION": ["bin"],
        "CATKIN_PACKAGE_SHARE_DESTINATION": share,
        "CATKIN_PACKAGE_PYTHON_DESTINATION": [f"lib/python3/site-packages/{name}"],
        "CATKIN_GLOBAL_PYTHON_DESTINATION": ["lib/python3/site-packages"],
        "PYTHON_INSTALL_DIR": ["lib/python3/site-packages"],
        "CMAKE_INSTALL_PREFIX": [""],
    }


def _words(text: str, variables: dict[str, list[str]]) -> Iterator[str]:
    for match in _WORD.finditer(text):
        yield from _expanded(match[2] if match[1] is None else match[1], variables, 0)


def _expanded(word: str, variables: dict[str, list[str]], depth: int) -> Iterator[str]:
    match = _VARIABLE.search(word)
    if match is None or depth > _DEEPEST:
        yield word
        return
    for value in variables.get(match[1], [""] if word != match[0] else []):
        yield from _expanded(word[: match.start()] + value + word[match.end() :], variables, depth + 1)


def _matching_files(package: Path, patterns: list[str]) -> list[str]:
    """Return the files below a package that match patterns, sorted."""
    files = []
    for pattern in patterns:
        below = pattern.removeprefix(f"{package}/")
        if below.startswith(("/", "..")) or not below or pattern in ("RELATIVE", "CONFIGURE_DEPENDS"):
            continue
        files += sorted(file.relative_to(package).as_posix() for file in package.glob(below) if file.is_file())
    return files
