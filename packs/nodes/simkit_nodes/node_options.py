"""Options of a program: what its command line, a script or a scenario changes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from simkit.argument_checks import check_kind, check_list, check_table, checked_number, wrong_value
from simkit.errors import InputError
from simkit.run_files import PackagePaths
from simkit_nodes.names import NameFault, RemapRule, namespace_error, node_name_error, parse_remap_rule

EVENTS: Final = ("start", "exit")
"""Events of a program for which another one can wait."""

Keys = str | Sequence[tuple[float, str]]
"""Text as of a file, or texts with the simulated times [s] at which somebody types them."""


@dataclass(frozen=True)
class NodeOptions:
    """Changes of a program by its command line, as after `--ros-args`.

    Attributes:
        name: name of the node; None for the one in the program.
        namespace: namespace of the node; None for the one in the program.
        remap: new names by old ones.
        params: values of parameters by name, for each node of the program.
        args: words of the command line of the program.
        latency: delay of messages to the program [s]; two numbers are the limits of a delay that is drawn for each
            message.
        discovery: simulated time until publishers and subscriptions of the program are matched [s]; at least one step.
        limit: wall time that the program may compute without waiting [s].
        restart: simulated time after which the program starts anew if it raised an exception [s]; None for never.
        keys: standard input of the program: a text as of a file, or texts with the simulated times [s] at which
            somebody types them; None if nobody types.
        label: name of the program in the conditions of others; None for the name of the program.
        after: `{"exit": LABEL}` or `{"start": LABEL}`: the program starts after this event of another program; an empty
            mapping for the begin of the run.
        delay: simulated time between the event, or the begin of the run, and the start [s].
        respawn: simulated time after which the program starts again whenever it has ended [s]; None for never.
        ends_run: True if the run ends with the program.
        env: variables of the environment of the program.
        cwd: working directory of the program; None for that of the process.
        package_paths: folders of ROS packages by name, or workspaces, besides the one around the program.
    """

    name: str | None = None
    namespace: str | None = None
    remap: Mapping[str, str] = field(default_factory=dict)
    params: Mapping[str, object] = field(default_factory=dict)
    args: Sequence[str] = ()
    latency: float | tuple[float, float] = 0.0
    discovery: float = 0.0
    limit: float = 60.0
    restart: float | None = None
    keys: Keys | None = None
    label: str | None = None
    after: Mapping[str, str] = field(default_factory=dict)
    delay: float = 0.0
    respawn: float | None = None
    ends_run: bool = False
    env: Mapping[str, str] = field(default_factory=dict)
    cwd: str | None = None
    package_paths: PackagePaths = ()

    def __post_init__(self) -> None:
        """Check the values, which scripts and files may give.

        Raises:
            InputError: SK-INPUT-002 a value has a wrong type; SK-INPUT-003 it is out of range or no valid name.
        """
        _check_name(self.name, "name", node_name_error)
        _check_name(self.namespace, "namespace", lambda name: namespace_error(f"/{name.strip('/')}"))
        check_table(self.remap, str, "remap", "names")
        check_table(self.params, object, "params", "values")
        check_list(self.args, str, "args", "texts")
        limits = self.latency if isinstance(self.latency, tuple) else (self.latency, self.latency)
        if len(limits) != 2:
            raise wrong_value("latency", "a number of seconds, or two", self.latency)
        least = checked_number(limits[0], "latency", 0.0, unit="s")
        checked_number(limits[1], "latency", least, unit="s")
        checked_number(self.discovery, "discovery", 0.0, unit="s")
        checked_number(self.limit, "limit", 0.001, unit="s")
        if self.restart is not None:
            checked_number(self.restart, "restart", 0.0, unit="s")
        self._check_start()
        if self.keys is not None and not isinstance(self.keys, str):
            check_list(self.keys, Sequence, "keys", "pairs of a time [s] and a text")
            for number, pair in enumerate(self.keys):
                if len(pair) != 2:
                    raise wrong_value(f"keys[{number}]", "a pair of a time [s] and a text", pair)
                checked_number(pair[0], f"the time of keys[{number}]", 0.0, unit="s")
                check_kind(pair[1], str, f"the text of keys[{number}]", "a text")

    def _check_start(self) -> None:
        """Check the condition for the start, and what holds for the process of the program."""
        if self.label is not None:
            check_kind(self.label, str, "label", "a text")
        check_table(self.after, str, "after", "labels of nodes")
        if len(self.after) > 1 or not set(self.after) <= set(EVENTS):
            raise wrong_value("after", 'a mapping such as {"exit": LABEL} or {"start": LABEL}', dict(self.after))
        checked_number(self.delay, "delay", 0.0, unit="s")
        if self.respawn is not None:
            checked_number(self.respawn, "respawn", 0.0, unit="s")
        check_kind(self.ends_run, bool, "ends_run", "True or False")
        check_table(self.env, str, "env", "texts")
        if self.cwd is not None:
            check_kind(self.cwd, str, "cwd", "a path")
            if not Path(self.cwd).is_dir():
                raise InputError("SK-INPUT-003", f"cwd: there is no folder {self.cwd!r}")

    def rules(self) -> list[RemapRule]:
        """Return the rules for names, as of `-r`.

        Raises:
            RosArgumentsError: an old or a new name is not valid.
        """
        rules = [parse_remap_rule(f"{old}:={new}") for old, new in self.remap.items()]
        if self.name:
            rules.append(RemapRule("", "node_name", "", self.name))
        if self.namespace:
            rules.append(RemapRule("", "namespace", "", "/" + self.namespace.strip("/")))
        return rules


def _check_name(name: object, argument: str, fault: Callable[[str], NameFault | None]) -> None:
    """Check a name of a node or a namespace; None and an empty text stand for that of the program."""
    if name is None or name == "":
        return
    check_kind(name, str, argument, "a text")
    reason = fault(str(name))
    if reason is not None:
        raise wrong_value(argument, f"valid ({reason[0]})", name)
