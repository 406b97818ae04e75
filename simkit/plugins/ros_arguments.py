"""Arguments of a ROS node in the `<ros>` block of a plugin: remappings, parameters and parameter files."""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit.diagnostics import Diagnostics, did_you_mean
from simkit.params import Params
from simkit.plugins.not_deep_copied import SharedByCopies

if TYPE_CHECKING:
    from simkit.plugins.ros_parameter_block import ParameterBlock
    from simkit.plugins.ros_parameter_files import ParameterFile

_REMAP, _PARAMETER, _FILE, _NO_EFFECT = range(4)
_FLAGS_WITH_VALUE: Final = {
    "-r": _REMAP,
    "--remap": _REMAP,
    "-p": _PARAMETER,
    "--param": _PARAMETER,
    "--params-file": _FILE,
    **dict.fromkeys(("-e", "--enclave", "--log-level", "--log-config-file", "--log-file-name"), _NO_EFFECT),
}
_LOG_TARGETS: Final = ("rosout-logs", "stdout-logs", "external-lib-logs")
_FLAGS: Final = ("--ros-args", "--", *(f"--{verb}-{name}" for verb in ("enable", "disable") for name in _LOG_TARGETS))
_RULE: Final = re.compile(r"(?:(?P<node>[A-Za-z_]\w*):)?(?:ros(?:topic|service)://)?(?P<name>[^:=]+):=(?P<value>.+)")
_WITHOUT_EFFECT: Final = ("use_sim_time", "robot_description", "qos_overrides")
_EXPECTED: Final = "from:=to, -r from:=to, -p name:=value or --params-file FILE"


@dataclass(frozen=True, slots=True)
class _Remapping:
    """Rule that replaces a name.

    Attributes:
        node: plain name of the node to which the rule applies; empty for every node of the plugin.
        source: name to replace, such as `odom`, `~/odom`, `/odom` or `__ns`.
        target: name that replaces it.
    """

    node: str
    source: str
    target: str


@dataclass(frozen=True, slots=True)
class _Setting:
    """Value of a parameter, or the URI of a parameter file if `name` is empty."""

    node: str
    name: str
    value: str
    element: Params


class RosArguments(SharedByCopies):
    """Arguments of a node, as after `--ros-args` on a command line.

    The words of an argument may be in one element or in several, as in `<argument>-r</argument>
    <argument>from:=to</argument>`. A rule `from:=to` without `-r` is a remapping.

    Args:
        ros: `<ros>` block; None for a plugin without one.
    """

    def __init__(self, ros: Params | None) -> None:
        self._remappings: list[_Remapping] = []
        self._settings: list[_Setting] = []
        self._used: set[str] = set()
        self._files: list[ParameterFile] | None = None
        if ros is None:
            return
        for element in ros.all("remapping"):
            self._read([(word, element) for word in element.value.split()], "from:=to")
        self._read(list(_words(ros.all("argument"))), _EXPECTED)
        for element in ros.all("parameter"):  # of gazebo_ros
            element.attribute("type")
            name = element.attribute("name")
            if name:
                self._settings.append(_Setting("", name, element.value, element))
            else:
                element.error("SK-PARAM-001", "<parameter> needs the attribute 'name'", '<parameter name="...">')

    def _read(self, words: list[tuple[str, Params]], expected: str) -> None:
        remaining = iter(words)
        for word, element in remaining:
            if word in _FLAGS:
                continue
            kind = _FLAGS_WITH_VALUE.get(word)
            value, place = (word, element) if kind is None else next(remaining, ("", element))
            rule = _RULE.fullmatch(value)
            if kind == _FILE and value:
                self._settings.append(_Setting("", "", value, place))
            elif kind == _PARAMETER and rule is not None:
                self._settings.append(_Setting(rule["node"] or "", rule["name"].strip(), rule["value"], place))
            elif kind in (_REMAP, None) and rule is not None:
                self._remappings.append(_Remapping(rule["node"] or "", rule["name"].strip(), rule["value"].strip()))
            elif kind != _NO_EFFECT or not value:
                text = word if kind is None or not value else f"{word} {value}"
                message = f"found <{element.name}>{text[:200]}</{element.name}>; expected {expected}"
                element.error("SK-PARAM-002", message, did_you_mean(word, (*_FLAGS, *_FLAGS_WITH_VALUE)))

    def remappings_of(self, node: str, *, only_own: bool = False) -> list[tuple[str, str]]:
        """Return source and target of the rules for a node; as in ROS, the first rule that matches is used.

        Args:
            node: plain name of the node.
            only_own: whether to leave out rules that have the same meaning in all nodes (`odom:=x`, `/odom:=x`).
        """
        rules = [rule for rule in self._remappings if rule.node in ("", node) and not rule.source.startswith("__")]
        return [(r.source, r.target) for r in rules if not only_own or r.node or r.source.startswith("~")]

    def special_names(self, node: str) -> dict[str, str]:
        """Return the new namespace of a node (`__ns`) and its new name (`__node`, `__name`), if the rules give them."""
        rules = [rule for rule in self._remappings if rule.node in ("", node) and rule.source.startswith("__")]
        return {rule.source: rule.target for rule in reversed(rules)}

    def parameter_files(self, find: Callable[[str], Path | None], diagnostics: Diagnostics) -> list[ParameterFile]:
        """Return the parameters and the parameter files of the arguments, in their order; read them at the first call.

        Args:
            find: function that returns the file of a URI; None if there is no such file.
            diagnostics: collector of the problems.
        """
        if self._files is None:
            self._files = [file for setting in self._settings for file in _read_setting(setting, find, diagnostics)]
        return self._files

    def values_of(
        self,
        node: str,
        name: str | None,
        find: Callable[[str], Path | None],
        diagnostics: Diagnostics,
        before: Sequence[ParameterFile] = (),
    ) -> ParameterBlock | None:
        """Return the parameters of a node by its full name; None if there is no value for the parameter `name`.

        If `name` is None, one parameter of any name is enough.

        Args:
            node: full name of the node.
            name: name of the parameter.
            find: function that returns the file of a URI; None if there is no such file.
            diagnostics: collector of the problems.
            before: parameter files whose values those of the arguments replace.
        """
        if not self._settings and not before:
            return None
        from simkit.plugins.ros_parameter_files import ParameterFiles

        self._used |= {"", name} if name is not None else {setting.name for setting in self._settings}
        entry = ParameterFiles([*before, *self.parameter_files(find, diagnostics)]).of_node(node)
        has_value = entry is not None and (name is None or name in (entry.below or {}))
        return entry.block(node, diagnostics) if entry is not None and has_value else None

    def report_unused(self, owner: str, diagnostics: Diagnostics) -> None:
        """Warn about parameters and parameter files that the owner, such as `plugin 'arm'`, has not read."""
        for setting in self._settings:
            if setting.name in self._used or setting.name in _WITHOUT_EFFECT:
                continue
            what = f"parameter {setting.name!r}" if setting.name else f"parameter file {setting.value[:200]}"
            diagnostics.warning("SK-PARAM-003", f"{owner}: the {what} of <ros> is not used", setting.element.where)


def _words(elements: list[Params]) -> Iterator[tuple[str, Params]]:
    """Yield the words of all elements; an element after a flag that takes a value is one word, such as a path."""
    last = ""
    for element in elements:
        try:
            words = [element.value] if last in _FLAGS_WITH_VALUE else shlex.split(element.value)
        except ValueError:  # a quote that is not closed
            words = element.value.split()
        yield from ((word, element) for word in words)
        last = words[-1] if words else last


def _read_setting(
    setting: _Setting, find: Callable[[str], Path | None], diagnostics: Diagnostics
) -> Iterator[ParameterFile]:
    from simkit.plugins.ros_parameter_files import ParameterFile, parse_parameter, read_parameter_file

    where = setting.element.where
    if setting.name:
        entry = parse_parameter(setting.name, setting.value, where, diagnostics)
        pattern = f"/**/{setting.node}" if setting.node else "/**"
        yield from [] if entry is None else [ParameterFile(Path(where.file or "arguments"), [(pattern, entry)])]
        return
    path = find(setting.value)
    if path is None:
        message = f"the parameter file {setting.value[:200]} is not found, so none of its parameters is read"
        hint = "give its package: --package-path NAME=DIR, or the file itself: --params-file FILE"
        diagnostics.warning("SK-CONTROL-015", message, where, hint)
        return
    file = read_parameter_file(path, diagnostics)
    yield from [] if file is None else [file]
