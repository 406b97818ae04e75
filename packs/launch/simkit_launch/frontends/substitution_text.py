"""Reader of texts with substitutions of ROS 2, such as `$(find-pkg-share robot)/urdf/$(var model).urdf`.

The rules are those of ROS 2: a backslash takes the next character as it is, the words of a substitution are separated
by spaces, and a word in quotes can have spaces, parentheses and further substitutions.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final

from simkit.diagnostics import did_you_mean
from simkit_launch.frontends.data_expression import DataExpression
from simkit_launch.frontends.launch_fault import LaunchFault
from simkit_launch.launch_modules.launch.substitution import Substitution
from simkit_launch.launch_modules.launch.substitutions import (
    AllSubstitution,
    AndSubstitution,
    AnonName,
    AnySubstitution,
    Command,
    EnvironmentVariable,
    EqualsSubstitution,
    FileContent,
    FindExecutable,
    IfElseSubstitution,
    LaunchConfiguration,
    LaunchLogDir,
    NotEqualsSubstitution,
    NotSubstitution,
    OrSubstitution,
    PathJoinSubstitution,
    StringJoinSubstitution,
    TextSubstitution,
    ThisLaunchFile,
    ThisLaunchFileDir,
)
from simkit_launch.launch_modules.launch_ros.substitutions import (
    ExecutableInPackage,
    FindPackagePrefix,
    FindPackageShare,
    Parameter,
)

INVALID_SUBSTITUTION: Final = "SK-LAUNCH-024"

Template = list[Substitution]
"""Text with substitutions."""


@dataclass(frozen=True)
class _Kind:
    """Kind of substitution.

    Attributes:
        make: function that makes it from its words.
        least: smallest number of words.
        most: largest number of words; None for any.
        form: form, for messages.
    """

    make: Callable[..., Substitution]
    least: int
    most: int | None
    form: str


def _modules(words: list[Template]) -> dict[str, Any]:
    """Return the argument of `$(eval …)` with the names of modules, which are separated by commas."""
    names = "".join(part.text for word in words for part in word if isinstance(part, TextSubstitution))
    return {"python_modules": [name.strip() for name in names.split(",")]} if words else {}


_KINDS: Final[Mapping[str, _Kind]] = {
    "var": _Kind(lambda name, default=None: LaunchConfiguration(name, default=default), 1, 2, "NAME [DEFAULT]"),
    "env": _Kind(lambda name, default=None: EnvironmentVariable(name, default_value=default), 1, 2, "NAME [DEFAULT]"),
    "eval": _Kind(lambda text, *modules: DataExpression(text, **_modules(list(modules))), 1, 2, "'EXPRESSION'"),
    "command": _Kind(lambda line, *rest: Command(line, **({"on_stderr": rest[0]} if rest else {})), 1, 2, "'COMMAND'"),
    "find-pkg-share": _Kind(FindPackageShare, 1, 1, "PACKAGE"),
    "find-pkg-prefix": _Kind(FindPackagePrefix, 1, 1, "PACKAGE"),
    "find-exec": _Kind(lambda name: FindExecutable(name=name), 1, 1, "PROGRAM"),
    "exec-in-pkg": _Kind(ExecutableInPackage, 2, 2, "EXECUTABLE PACKAGE"),
    "param": _Kind(lambda name, default=None: Parameter(name, default=default), 1, 2, "NAME [DEFAULT]"),
    "dirname": _Kind(ThisLaunchFileDir, 0, 0, ""),
    "filename": _Kind(ThisLaunchFile, 0, 0, ""),
    "log_dir": _Kind(LaunchLogDir, 0, 0, ""),
    "launch_log_dir": _Kind(LaunchLogDir, 0, 0, ""),
    "anon": _Kind(AnonName, 1, 1, "NAME"),
    "not": _Kind(NotSubstitution, 1, 1, "VALUE"),
    "and": _Kind(AndSubstitution, 2, 2, "VALUE VALUE"),
    "or": _Kind(OrSubstitution, 2, 2, "VALUE VALUE"),
    "any": _Kind(AnySubstitution, 0, None, "VALUE …"),
    "all": _Kind(AllSubstitution, 0, None, "VALUE …"),
    "equals": _Kind(EqualsSubstitution, 2, 2, "VALUE VALUE"),
    "not-equals": _Kind(NotEqualsSubstitution, 2, 2, "VALUE VALUE"),
    "if": _Kind(IfElseSubstitution, 2, 3, "CONDITION VALUE [VALUE]"),
    "file-content": _Kind(FileContent, 1, 1, "FILE"),
    "path-join": _Kind(lambda *parts: PathJoinSubstitution(parts), 1, None, "PART …"),
    "string-join": _Kind(lambda between, *parts: StringJoinSubstitution(parts, between), 1, None, "TEXT PART …"),
}

_LOOP_VALUES: Final = ("for-var", "index")  # values of the loops `for_each` and `for`

_OF_ROS_1: Final = {"find": "find-pkg-share", "arg": "var", "optenv": "env"}

_NAME: Final = re.compile(r"[A-Za-z][\w-]*")


def parse_substitutions(text: str, loop_values: Mapping[str, str] | None = None) -> Template:
    """Return the parts of a text with substitutions.

    Args:
        text: text.
        loop_values: values of the loops around the text, by name.

    Raises:
        LaunchFault: a substitution has an error.
    """
    return _Scanner(text, {} if loop_values is None else loop_values).template("") or [TextSubstitution(text="")]


def unescape(text: str) -> str:
    """Return a text without substitutions, in which a backslash takes the next character as it is."""
    return re.sub(r"\\(.)", r"\1", text)


class _Scanner:
    """Reader of one text."""

    def __init__(self, text: str, loop_values: Mapping[str, str]) -> None:
        self.text, self.loop_values = text, loop_values
        self.at = 0

    def template(self, quote: str) -> Template:
        """Read up to a quote, or to the end of the text if the quote is empty."""
        parts: Template = []
        plain = ""
        while self.at < len(self.text) and self.text[self.at] != quote:
            if self._starts_substitution():
                parts += [TextSubstitution(text=plain)] if plain else []
                plain = ""
                parts.append(self._substitution(quote))
            else:
                plain += self._character()
        return [*parts, TextSubstitution(text=plain)] if plain else parts

    def _starts_substitution(self) -> bool:
        return self.text.startswith("$(", self.at)

    def _character(self) -> str:
        """Read one character, or that after a backslash."""
        if self.text[self.at] == "\\" and self.at + 1 < len(self.text):
            self.at += 1
        self.at += 1
        return self.text[self.at - 1]

    def _substitution(self, quote: str) -> Substitution:
        begin = self.at
        self.at += 2
        match = _NAME.match(self.text, self.at)
        if match is None:
            raise self._fault(f"found {self.text[begin : begin + 20]!r}; expected the name of a substitution after $(")
        self.at = match.end()
        words: list[Template] = []
        while True:
            spaces = self._skip_spaces()
            if self.at >= len(self.text) or (quote and self.text[self.at] == quote):
                raise self._fault(f"found {self.text[begin:]!r}; the substitution has no closing parenthesis")
            if self.text[self.at] == ")":
                self.at += 1
                return self._made(match[0], words, self.text[begin : self.at])
            if not spaces:
                raise self._fault(f"found {self.text[begin : self.at + 1]!r}; expected a space or a parenthesis")
            words.append(self._word(quote))

    def _skip_spaces(self) -> bool:
        begin = self.at
        while self.at < len(self.text) and self.text[self.at].isspace():
            self.at += 1
        return self.at > begin

    def _word(self, quote: str) -> Template:
        """Read a word of a substitution: in quotes, or up to a space or parenthesis."""
        first = self.text[self.at]
        if not quote and first in "'\"":
            begin = self.at
            self.at += 1
            parts = self.template(first)
            if self.at >= len(self.text):
                raise self._fault(f"found {self.text[begin:]!r}; the quote is not closed")
            self.at += 1
            return parts or [TextSubstitution(text="")]
        parts, plain = [], ""
        while self.at < len(self.text) and not self.text[self.at].isspace() and self.text[self.at] not in (")", quote):
            if self._starts_substitution():
                parts += [TextSubstitution(text=plain)] if plain else []
                plain = ""
                parts.append(self._substitution(quote))
            elif self.text[self.at] == "(":
                hint = "put the word in quotes, as in $(eval '2 * (3 + 4)')"
                raise self._fault(f"found {self.text!r}; a word without quotes has no parenthesis", hint)
            else:
                plain += self._character()
        return [*parts, TextSubstitution(text=plain)] if plain else parts

    def _made(self, name: str, words: list[Template], shown: str) -> Substitution:
        if name in _LOOP_VALUES:
            return self._loop_value(words, shown)
        kind = _KINDS.get(name)
        if kind is None:
            near = _OF_ROS_1.get(name)
            hint = f"ROS 2 has $({near} {_KINDS[near].form})" if near else did_you_mean(name, _KINDS)
            hint = hint or f"there are {', '.join(_KINDS)}"
            raise self._fault(f"there is no substitution {shown}", hint)
        if len(words) < kind.least or (kind.most is not None and len(words) > kind.most):
            form = f"$({name} {kind.form})".replace(" )", ")")
            hint = "put a word with spaces in quotes" if kind.most is not None and len(words) > kind.most else ""
            raise self._fault(f"found {shown}; expected {form}", hint)
        return kind.make(*words)

    def _loop_value(self, words: list[Template], shown: str) -> Substitution:
        texts = ["".join(part.text for part in word if isinstance(part, TextSubstitution)) for word in words]
        if not texts:
            raise self._fault(f"found {shown}; expected the name of a value of the loop")
        if texts[0] in self.loop_values:
            return TextSubstitution(text=self.loop_values[texts[0]])
        if len(texts) > 1:
            return TextSubstitution(text=texts[1])
        known = ", ".join(self.loop_values) or "none"
        raise self._fault(f"{shown}: no loop around the text has this value; there is {known}")

    def _fault(self, message: str, hint: str = "") -> LaunchFault:
        return LaunchFault(INVALID_SUBSTITUTION, message, hint)
