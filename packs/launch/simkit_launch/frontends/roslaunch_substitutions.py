"""Substitutions of launch files of ROS 1: `$(find PACKAGE)`, `$(arg NAME)`, `$(eval EXPRESSION)` and others."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from simkit.diagnostics import Diagnostics, Where, did_you_mean
from simkit.loaders.xacro.expansion_limits import Budget, ExpansionError
from simkit.loaders.xacro.expression import Evaluator, Function
from simkit.loaders.xacro.expression_functions import math_functions, python_functions
from simkit_launch.frontends.launch_fault import LaunchFault
from simkit_launch.frontends.roslaunch_values import convert_text
from simkit_launch.launch_environment import variable
from simkit_launch.launch_packages import LaunchPackages

INVALID_SUBSTITUTION: Final = "SK-LAUNCH-024"

COMMANDS: Final = ("find", "arg", "env", "optenv", "dirname", "anon", "eval")

_SUBSTITUTION: Final = re.compile(r"\$\(([^()$]*)\)")
_ARGUMENT: Final = re.compile(r"\$\(\s*arg\s+([^()$\s]+)\s*\)")
_EVAL_FUNCTIONS: Final = ("list", "dict", "map", "str", "float", "int")


class UnsetArgument(LaunchFault):
    """Argument without a value.

    Attributes:
        name: name of the argument.
        names: names of all arguments without a value in the same text.
    """

    def __init__(self, name: str, known: Mapping[str, str], others: Iterable[str] = ()) -> None:
        near = did_you_mean(name, sorted(known))
        message = f"the argument {name!r} has no value" + (f"; {near}" if near else "")
        super().__init__(INVALID_SUBSTITUTION, message, f"declare it: <arg name={name!r} default=…/>".replace("'", '"'))
        self.name, self.names = name, tuple(dict.fromkeys((name, *others)))


@dataclass
class AnonymousNames:
    """Names that `$(anon ID)` makes: one for each ID of a file, none of them twice in a launch.

    Attributes:
        by_id: names of the present file by ID.
        used: all names so far; files that include each other share them.
    """

    by_id: dict[str, str] = field(default_factory=dict)
    used: set[str] = field(default_factory=set)

    def name(self, identifier: str) -> str:
        """Return the name for an ID: the ID with the first free number."""
        if identifier not in self.by_id:
            number = 1
            while f"{identifier}_{number}" in self.used:
                number += 1
            self.by_id[identifier] = f"{identifier}_{number}"
            self.used.add(self.by_id[identifier])
        return self.by_id[identifier]

    def copy(self) -> AnonymousNames:
        """Return the names for an inner scope: known IDs keep their names, and no name is used twice."""
        return AnonymousNames(dict(self.by_id), self.used)


@dataclass
class Substitutions:
    """Substitutions with the values of one scope.

    Attributes:
        arguments: values of arguments by name.
        declared: names of the arguments that the file declares.
        anonymous: names of `$(anon …)`.
        file: launch file.
        packages: ROS packages.
        diagnostics: collection that receives warnings.
    """

    arguments: Mapping[str, str]
    declared: Collection[str]
    anonymous: AnonymousNames
    file: Path
    packages: LaunchPackages
    diagnostics: Diagnostics

    def resolve(self, text: str, where: Where) -> str:
        """Return a text in which all substitutions are replaced.

        Raises:
            LaunchFault: a substitution has an error.
        """
        if "$(" not in text:
            return text
        if text.startswith("$(eval ") and text.endswith(")"):
            return self._evaluate(text[len("$(eval ") : -1], where)
        self._check_form(text)
        unset = [name for name in _ARGUMENT.findall(text) if name not in self.arguments]
        if unset:
            raise UnsetArgument(unset[0], self.arguments, unset)
        # a value of an argument can name a package: the packages come last, as in roslaunch
        text = _SUBSTITUTION.sub(lambda match: self._replaced(match, where, is_find=False), text)
        return _SUBSTITUTION.sub(lambda match: self._replaced(match, where, is_find=True), text)

    def _check_form(self, text: str) -> None:
        rest = _SUBSTITUTION.sub("", text)
        if "$(eval " in text:
            message = f"found {text!r}; $(eval …) has to be the whole text"
            hint = "write the rest of the text into the expression: $(eval 'robot' + str(number))"
        elif "$(" not in rest:
            return
        elif ")" not in rest:
            message, hint = f"found {text!r}; a substitution has no closing parenthesis", ""
        else:
            message = f"found {text!r}; a substitution of ROS 1 contains no other substitution and no parentheses"
            hint = "give the inner one to an <arg> first, or compute the text with $(eval …)"
        raise LaunchFault(INVALID_SUBSTITUTION, message, hint)

    def _replaced(self, match: re.Match[str], where: Where, *, is_find: bool) -> str:
        name, *words = match[1].split() or [""]
        if name not in COMMANDS:
            near = did_you_mean(name, COMMANDS)
            message = f"there is no substitution $({match[1]})" + (f"; {near}" if near else "")
            raise LaunchFault(INVALID_SUBSTITUTION, message, f"ROS 1 has {', '.join(COMMANDS)}")
        if (name == "find") != is_find:
            return match[0]
        if name == "optenv" and words:
            value = self._variable(words[0], where)
            return " ".join(words[1:]) if value is None else value
        if len(words) != (0 if name == "dirname" else 1):
            needed = "no word" if name == "dirname" else "one word"
            raise LaunchFault(INVALID_SUBSTITUTION, f"found $({match[1]}); expected {needed} after {name!r}")
        one = words[0] if words else ""
        functions: dict[str, Callable[[], str]] = {
            "find": lambda: str(self.packages.folder(one, where)),
            "arg": lambda: self._argument(one),
            "env": lambda: self._required_variable(one, where),
            "dirname": self._folder,
            "anon": lambda: self.anonymous.name(one),
        }
        return functions[name]()

    def _argument(self, name: str) -> str:
        if name not in self.arguments:
            raise UnsetArgument(name, self.arguments)
        return self.arguments[name]

    def _variable(self, name: str, where: Where) -> str | None:
        return variable(name, where, self.diagnostics, self.packages, is_ros1=True)

    def _required_variable(self, name: str, where: Where) -> str:
        value = self._variable(name, where)
        if value is None:
            hint = f"set it: {name}=… simkit launch {self.file.name}"
            raise LaunchFault(INVALID_SUBSTITUTION, f"the environment variable {name} is not set", hint)
        return value

    def _folder(self) -> str:
        return str(self.file.absolute().parent)

    def _evaluate(self, expression: str, where: Where) -> str:
        if "__" in expression:
            raise LaunchFault(
                INVALID_SUBSTITUTION, f"found $(eval {expression}); an expression has no double underscore"
            )
        evaluator = Evaluator({}, Budget())
        python = python_functions(evaluator)
        names: dict[str, Any] = {name: convert_text(value) for name, value in self.arguments.items()}
        names |= math_functions()
        names |= {name: python[name] for name in _EVAL_FUNCTIONS}
        names |= {"true": True, "false": False}
        names |= {
            "arg": Function(lambda name: convert_text(self._argument(str(name)))),
            "env": Function(lambda name: self._required_variable(str(name), where)),
            "optenv": Function(lambda name, default="": self._optional_variable(str(name), default, where)),
            "find": Function(lambda name: str(self.packages.folder(str(name), where))),
            "anon": Function(lambda name: self.anonymous.name(str(name))),
            "dirname": Function(self._folder),
        }
        evaluator.names = names
        try:
            return str(evaluator.run(expression))
        except LaunchFault:
            raise
        except ExpansionError as error:
            missing = re.search(r"name '(\w+)' is not defined", str(error))
            if missing and missing[1] in self.declared:
                raise UnsetArgument(missing[1], self.arguments) from None
            hint = did_you_mean(missing[1], sorted(names)) if missing else ""
            raise LaunchFault(INVALID_SUBSTITUTION, f"$(eval {expression}): {error}", hint) from None

    def _optional_variable(self, name: str, default: Any, where: Where) -> Any:
        value = self._variable(name, where)
        return default if value is None else value
