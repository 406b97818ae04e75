"""Output of the commands that launch files run while they are read, without starting a program: xacro, cat and echo."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path, PurePath
from typing import Final

from simkit.errors import InputError
from simkit.extend import Diagnostics, Where, counted
from simkit.input_file import read_failure, read_input_text
from simkit.loaders import Resolver, find_document
from simkit.run_files import PackagePaths
from simkit.writers.xml_text import document as xml_document
from simkit_launch.command_line import run_executable, started_commands
from simkit_launch.launch_packages import missing_package_of

LEFT_OUT: Final = "SK-LAUNCH-022"
"""Code of the warning for a command whose output is left out."""

_OPTIONS_WITH_VALUE: Final = ("-o", "--verbosity")


def command_output(
    words: Sequence[str], where: Where, diagnostics: Diagnostics, package_paths: PackagePaths | None = None
) -> str | None:
    """Return the output of a command; None, with a warning, if the output is left out.

    Args:
        words: words of the command line.
        where: place in the launch file.
        diagnostics: collection that receives the problems.
        package_paths: folders of packages by name, or workspaces.
    """
    line = " ".join(words)
    program, rest = _program(words)
    if program in ("xacro", "xacro.py"):
        return xacro_output(rest, where, diagnostics, package_paths)
    if program == "echo":
        return " ".join(rest) + "\n"
    if program == "cat" and rest:
        texts = [_file_text(Path(file), line, where, diagnostics) for file in rest if not file.startswith("-")]
        return None if None in texts else "".join(text for text in texts if text is not None)
    message = f"the output of `{line}` is left out: only xacro, cat and echo run without ROS"
    hint = "write the output of the command into a file, and let the launch file read this file"
    diagnostics.warning(LEFT_OUT, message, where, hint)
    return None


def xacro_output(
    words: Sequence[str], where: Where, diagnostics: Diagnostics, package_paths: PackagePaths | None = None
) -> str | None:
    """Return the expanded text of a xacro file; None, with a warning, if the file cannot be expanded.

    Args:
        words: words after `xacro`: options, the file, and arguments such as `name:=value`.
        where: place in the launch file.
        diagnostics: collection that receives the problems.
        package_paths: folders of packages by name, or workspaces.
    """
    files, arguments = split_xacro_words(words)
    if len(files) != 1:
        message = f"`xacro {' '.join(words)}` is left out: it names {counted(len(files), 'file')}; xacro takes one"
        diagnostics.warning(LEFT_OUT, message, where)
        return None
    file = Path(files[0])
    problems = Diagnostics()
    if package := missing_package_of(file):
        reason = f"it is in the package {package!r}, which is not there"
    else:
        try:
            resolver = Resolver([], missing_includes=True, package_paths=package_paths)
            document, _ = find_document(file, resolver, problems, arguments)
        except InputError as error:
            document, reason = None, str(error)
        else:
            reason = next((str(problem) for problem in problems if problem.severity == "error"), "")
        if document is not None and not problems.has_errors:
            diagnostics.extend(problems)
            return xml_document(document.root)
    message = f"the model of xacro file {file} is left out: {reason or 'it has no content'}"
    diagnostics.warning(LEFT_OUT, message.replace("\n", " "), where)
    return None


def split_xacro_words(words: Iterable[str]) -> tuple[list[str], dict[str, str]]:
    """Split the words after `xacro` into files and the arguments by name; options are dropped."""
    files: list[str] = []
    arguments: dict[str, str] = {}
    expects_value = False
    for word in words:
        name, assigns, value = word.partition(":=")
        if expects_value:
            expects_value = False
        elif word.startswith("-"):
            expects_value = word in _OPTIONS_WITH_VALUE
        elif assigns:
            arguments[name] = value
        elif word:
            files.append(word)
    return files, arguments


def _program(words: Sequence[str]) -> tuple[str, list[str]]:
    """Return the name of the program that a command line starts, and the words after it."""
    commands = started_commands(words)
    rest = list(commands[-1].words) if commands else []
    executable = run_executable(rest)
    if executable is not None:
        _, name, arguments = executable
        return name, list(arguments)
    return (PurePath(rest[0]).name, rest[1:]) if rest else ("", [])


def _file_text(file: Path, line: str, where: Where, diagnostics: Diagnostics) -> str | None:
    try:
        return read_input_text(file)
    except (OSError, ValueError) as error:
        diagnostics.warning(LEFT_OUT, f"the output of `{line}` is left out: {file}: {read_failure(error)}", where)
        return None
