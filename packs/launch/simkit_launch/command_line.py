"""Command lines, split into the programs that they start one after the other. No shell is started."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import PurePath
from typing import Final

_SHELLS: Final = frozenset(("bash", "dash", "sh", "zsh"))
_LINE_OPTION: Final = re.compile(r"-[a-z]*c")
"""Option of a shell before the line that it runs."""
_STARTERS: Final = {
    "env": ("-u",),
    "gnome-terminal": ("--title", "--geometry"),
    "konsole": (),
    "nice": ("-n",),
    "ruby": (),
    "stdbuf": ("-i", "-o", "-e"),
    "sudo": ("-u",),
    "taskset": ("-c",),
    "time": (),
    "xterm": ("-T", "-title", "-geometry"),
    "xvfb-run": ("-s", "-n"),
}
"""Programs that start the program in their last words, with those of their options whose value is the next word."""
_TERMINALS: Final = ("gnome-terminal", "konsole", "xterm")
_COMMAND_OPTIONS: Final = ("-e", "-x", "--")
"""Options of a terminal before its command."""
_PYTHON: Final = re.compile(r"python[23]?(\.\d+)?")
_ASSIGNMENT: Final = re.compile(r"[A-Za-z_]\w*=")
_WHICH: Final = re.compile(r"\$\(\s*which\s+(\S+?)\s*\)|`\s*which\s+(\S+?)\s*`")
_ENDS: Final = frozenset(("&&", ";", "||", "&", "\n", ";;"))
_WITHOUT_EFFECT: Final = frozenset(("source", ".", "set", "true", ":"))


@dataclass(frozen=True)
class ShellCommand:
    """Command that a line starts.

    Attributes:
        words: words of the command line, with the program first.
        folder: working directory; empty for the present one.
        variables: variables of the environment that the line sets.
    """

    words: tuple[str, ...]
    folder: str = ""
    variables: dict[str, str] = field(default_factory=dict)


def started_commands(words: Iterable[str], *, is_shell: bool = False) -> list[ShellCommand]:
    """Return the commands that a command line starts, one after the other.

    Shells, terminals, interpreters, and programs such as `env` and `nice` are replaced by what they start. The part of
    a line after `|` is left out. A line with an error, such as a quote that does not end, is one command.

    Args:
        words: words of the command line; a single word with spaces is a line of a shell.
        is_shell: True if the words are a line of a shell.
    """
    if is_shell:
        return _of_line(" ".join(words))
    rest = [word for word in words if word]
    variables: dict[str, str] = {}
    while rest:
        if len(rest) == 1 and " " in rest[0]:
            return _with_variables(_of_line(rest[0]), variables)
        name = PurePath(rest[0]).name
        if _ASSIGNMENT.match(rest[0]):
            variable, _, variables[variable] = rest.pop(0).partition("=")
        elif name in _SHELLS:
            at = next((at for at, word in enumerate(rest[1:3], 1) if _LINE_OPTION.fullmatch(word)), 0)
            if at and len(rest) > at + 1:
                return _with_variables(_of_line(rest[at + 1]), variables)
            rest = [] if len(rest) == 1 else rest[1:]
        elif name in _STARTERS and len(rest) > 1:
            rest = _after_options(name, rest[1:])
        elif _PYTHON.fullmatch(name) and len(rest) > 1 and (rest[1] == "-u" or not rest[1].startswith("-")):
            rest = rest[2:] if rest[1] == "-u" else rest[1:]
        else:
            break
    return [ShellCommand(tuple(rest), "", variables)] if rest else []


def run_executable(words: Sequence[str]) -> tuple[str, str, tuple[str, ...]] | None:
    """Return package, executable and further words of `ros2 run` and `rosrun`; None for another command."""
    rest = list(words)
    program = PurePath(rest[0]).name if rest else ""
    if program == "ros2" and rest[1:2] == ["run"]:
        rest = rest[2:]
    elif program == "rosrun":
        rest = rest[1:]
    else:
        return None
    while rest and rest[0].startswith("-"):
        rest = rest[2:] if rest[0] == "--prefix" else rest[1:]
    return (rest[0], rest[1], tuple(rest[2:])) if len(rest) > 1 else None


def _with_variables(commands: Iterable[ShellCommand], variables: dict[str, str]) -> list[ShellCommand]:
    return [replace(command, variables={**variables, **command.variables}) for command in commands]


def _after_options(name: str, words: list[str]) -> list[str]:
    """Return the words after the options of a program that starts another one."""
    if name in _TERMINALS:
        at = next((at for at, word in enumerate(words) if word in _COMMAND_OPTIONS), None)
        return [] if at is None else words[at + 1 :]
    while words and words[0].startswith("-"):
        words = words[2:] if words[0] in _STARTERS[name] else words[1:]
    return words


def _of_line(line: str) -> list[ShellCommand]:
    """Return the commands of a line of a shell: those after `&&`, `||`, `;`, `&`."""
    line = _WHICH.sub(lambda found: found[1] or found[2], line.replace("\\\n", " ").replace("\n", " ; "))
    lexer = shlex.shlex(line, posix=True, punctuation_chars=";&|<>")
    lexer.whitespace_split = True
    try:
        words = list(lexer)
    except ValueError:
        return [ShellCommand(tuple(line.split()))]
    commands: list[ShellCommand] = []
    folder = ""
    variables: dict[str, str] = {}
    for part in _parts(words):
        if part[:1] == ["exec"]:
            part = part[1:]
        if not part or part[0] in _WITHOUT_EFFECT:
            continue
        if all(map(_ASSIGNMENT.match, part)):
            variables.update({name: value for name, _, value in (word.partition("=") for word in part)})
        elif part[0] == "cd":
            folder = part[1] if len(part) > 1 else folder
        elif part[0] == "export":
            variables.update({name: value for name, _, value in (word.partition("=") for word in part[1:])})
        else:
            for command in _with_variables(started_commands(part), variables):
                commands.append(replace(command, folder=command.folder or folder))
    return commands


def _parts(words: Iterable[str]) -> Iterator[list[str]]:
    """Yield the words of each command without redirections."""
    part: list[str] = []
    is_piped = skips_next = False
    for word in words:
        if word in _ENDS:
            yield part
            part, is_piped, skips_next = [], False, False
        elif word in ("|", "|&"):
            is_piped = True
        elif word.startswith((">", "<")):
            if part and part[-1] in ("1", "2"):
                part.pop()
            skips_next = not word.endswith("&")
        elif skips_next:
            skips_next = False
        elif not is_piped:
            part.append(word)
    yield part
