"""Substitutions that change files of parameters; the changed files are written for the run."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import yaml

from simkit.input_file import read_input_text
from simkit_launch.launch_modules.launch.substitution import Substitution
from simkit_launch.launch_modules.launch.substitutions import LaunchConfiguration
from simkit_launch.launch_modules.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from simkit_launch.planner import current_planner

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.condition import Condition
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext
    from simkit_launch.launch_modules.launch.some_substitutions_type import SomeSubstitutionsType

__all__ = ["HasNodeParams", "LaunchConfigAsBool", "ParseMultiRobotPose", "ReplaceString", "RewrittenYaml"]


class _FileSubstitution(Substitution):
    """Path of a file that is made from another one."""

    def __init__(self, source_file: SomeSubstitutionsType) -> None:
        self._source = normalize_to_list_of_substitutions(source_file)

    @property
    def name(self) -> list[Substitution]:
        """Path of the file that is changed."""
        return self._source

    def _file(self, context: LaunchContext) -> Path | None:
        """Return the file that is changed; None, with a warning, if it is not there."""
        planner = context.planner
        file: Path | None = planner.parameter_file(Path(perform_substitutions(context, self._source)), planner.place)
        return file


class RewrittenYaml(_FileSubstitution):
    """Path of a YAML file with other values.

    Args:
        source_file: path of the file.
        param_rewrites: new values, by the name of the parameter or by its whole path `node.ros__parameters.name`.
        root_key: name under which everything is put; empty for none.
        key_rewrites: new names, by old names.
        value_rewrites: new values, by old values.
        convert_types: True to convert texts to numbers.
    """

    def __init__(
        self,
        source_file: SomeSubstitutionsType,
        param_rewrites: Mapping[str, SomeSubstitutionsType],
        root_key: SomeSubstitutionsType | None = None,
        key_rewrites: Mapping[str, SomeSubstitutionsType] | None = None,
        value_rewrites: Mapping[str, SomeSubstitutionsType] | None = None,
        convert_types: bool = False,
    ) -> None:
        super().__init__(source_file)
        self._values, self._keys = _normalised(param_rewrites), _normalised(key_rewrites)
        self._texts = _normalised(value_rewrites)
        self._root = None if root_key is None else normalize_to_list_of_substitutions(root_key)
        self._convert_types = convert_types

    def perform(self, context: LaunchContext) -> str:
        """Write the file; return its path."""
        file = self._file(context)
        if file is None:
            return perform_substitutions(context, self._source)
        data = yaml.safe_load(read_input_text(file)) or {}
        values = {name: self._converted(text) for name, text in _performed(context, self._values).items()}
        texts = _performed(context, self._texts)
        known: set[str] = set()
        data = _rewritten(data, "", values, texts, known)
        for path, value in values.items():
            if path not in known and "ros__parameters" in path.split("."):
                _put(data, path.split("."), value)
        data = _renamed(data, _performed(context, self._keys))
        root = "" if self._root is None else perform_substitutions(context, self._root)
        text = yaml.safe_dump({root: data} if root else data, sort_keys=False)
        return str(context.planner.write_file(file.stem, ".yaml", text))

    def _converted(self, text: str) -> Any:
        if self._convert_types:
            try:
                return float(text) if "." in text else int(text)
            except ValueError:
                pass
        return {"true": True, "false": False}.get(text.lower(), text)


def _normalised(texts: Mapping[str, SomeSubstitutionsType] | None) -> dict[str, list[Substitution]]:
    return {name: normalize_to_list_of_substitutions(text) for name, text in (texts or {}).items()}


def _performed(context: LaunchContext, texts: Mapping[str, list[Substitution]]) -> dict[str, str]:
    return {name: perform_substitutions(context, text) for name, text in texts.items()}


def _rewritten(data: Any, path: str, values: Mapping[str, Any], texts: Mapping[str, str], known: set[str]) -> Any:
    """Return data with the values for whole paths and for last names.

    Args:
        data: data.
        path: path of the data, with dots.
        values: new values.
        texts: new values by old values.
        known: receives the paths of all values.
    """
    if isinstance(data, dict):
        result = {}
        for name, value in data.items():
            inner = f"{path}.{name}" if path else str(name)
            if inner in values or str(name) in values:
                known.add(inner)
                result[name] = values[inner] if inner in values else values[str(name)]
            else:
                result[name] = _rewritten(value, inner, values, texts, known)
        return result
    known.add(path)
    if isinstance(data, list):
        inner_paths = (f"{path}.{number}" for number in range(len(data)))
        return [
            values[inner] if inner in values else _rewritten(each, inner, values, texts, known)
            for inner, each in zip(inner_paths, data, strict=True)
        ]
    return texts.get(data, data) if isinstance(data, str) else data


def _put(data: Any, names: list[str], value: Any) -> None:
    for name in names[:-1]:
        data = data.setdefault(name, {})
        if not isinstance(data, dict):
            return
    data[names[-1]] = value


def _renamed(data: Any, keys: Mapping[str, str]) -> Any:
    if not isinstance(data, dict) or not keys:
        return data
    return {keys.get(name, name): _renamed(value, keys) for name, value in data.items()}


class ReplaceString(_FileSubstitution):
    """Path of a file in which texts are replaced.

    Args:
        source_file: path of the file.
        replacements: new texts, by old texts.
        condition: condition without which the file stays as it is.
    """

    def __init__(
        self,
        source_file: SomeSubstitutionsType,
        replacements: Mapping[str, SomeSubstitutionsType],
        condition: Condition | None = None,
    ) -> None:
        super().__init__(source_file)
        self._replacements, self._condition = _normalised(replacements), condition

    @property
    def condition(self) -> Condition | None:
        """Condition without which the file stays as it is."""
        return self._condition

    def perform(self, context: LaunchContext) -> str:
        """Write the file; return its path."""
        if self._condition is not None and not self._condition.evaluate(context):
            return perform_substitutions(context, self._source)
        file = self._file(context)
        if file is None:
            return perform_substitutions(context, self._source)
        text = read_input_text(file)
        for old, new in _performed(context, self._replacements).items():
            text = text.replace(old, new)
        return str(context.planner.write_file(file.stem, file.suffix, text))


class HasNodeParams(_FileSubstitution):
    """`True` if a file has parameters of a node.

    Args:
        source_file: path of the file.
        node_name: name of the node.
    """

    def __init__(self, source_file: SomeSubstitutionsType, node_name: str) -> None:
        super().__init__(source_file)
        self._node = node_name

    def perform(self, context: LaunchContext) -> str:
        """Return `True` or `False`."""
        file = self._file(context)
        data = {} if file is None else yaml.safe_load(read_input_text(file)) or {}
        return str(self._node in data)


class LaunchConfigAsBool(LaunchConfiguration):
    """Value of a launch configuration as `True` or `False`.

    Args:
        name: name of the launch configuration.
    """

    def __init__(self, name: str) -> None:
        super().__init__(name)

    def perform(self, context: LaunchContext) -> str:
        """Return `True` or `False`."""
        return str(super().perform(context).strip().lower() in ("1", "true", "yes", "on"))


class ParseMultiRobotPose(Substitution):
    """Poses of several robots.

    Args:
        robots_argument: text such as `robot1={x: 1.0, yaw: 0.5}; robot2={x: 2.0}`; or the name of a launch argument.
    """

    def __init__(self, robots_argument: Any) -> None:
        is_name = isinstance(robots_argument, str)
        self._text: Substitution = LaunchConfiguration(robots_argument, default="") if is_name else robots_argument

    def perform(self, context: LaunchContext) -> Any:
        """Return the poses by the names of the robots."""
        return _poses(self._text.perform(context))

    def value(self) -> dict[str, dict[str, float]]:
        """Return the poses of the argument on the command line."""
        text = str(self._text.describe())
        names = current_planner().plan.arguments
        return _poses(next((value for name, value in names.items() if f"'{name}'" in text), ""))


def _poses(text: str) -> dict[str, dict[str, float]]:
    poses: dict[str, dict[str, float]] = {}
    for part in text.split(";"):
        name, equals, pose = part.partition("=")
        if equals:
            poses[name.strip()] = {
                **dict.fromkeys(("x", "y", "z", "roll", "pitch", "yaw"), 0.0),
                **(yaml.safe_load(pose) or {}),
            }
    return poses
