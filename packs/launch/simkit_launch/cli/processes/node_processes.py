"""Nodes of a launch file as processes of their own beside the simulation: `simkit launch --processes`."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import Any, Final

from simkit.cli.run_part import OpenRun, RunPart
from simkit.cli.terminal.output import print_message, print_status
from simkit.errors import InputError, NodeError
from simkit.process_control import kill_process_tree
from simkit.run_nodes import ROS_ARGUMENTS, label_of, node_arguments
from simkit.run_spec import RunSpec
from simkit_nodes.known_nodes import known_node
from simkit_nodes.parameter_overrides import flat_values

_START_TIMEOUT: Final = 60.0  # [s] of wall time
_POLL: Final = 0.02  # [s] of wall time
_GRACE: Final = 5.0  # [s] of wall time that a process gets to end after Ctrl-C


@dataclass
class _NodeProcess:
    """One node and its process.

    Attributes:
        node: arguments of `sim.add_node`.
        process: present process; None before the start.
        due: simulated time of the next start [s]; None if no condition has come true.
        is_over: True after the last end.
    """

    node: Mapping[str, Any]
    process: subprocess.Popen[bytes] | None = None
    due: float | None = None
    is_over: bool = False

    @property
    def label(self) -> str:
        return str(self.node.get("label") or label_of(self.node))


@dataclass
class NodeProcesses(RunPart):
    """Part of a run that starts nodes as processes, and ends them with the run.

    Attributes:
        nodes: nodes, as in a run specification.
        package_paths: options `--package-path` of the processes.
    """

    nodes: Sequence[Mapping[str, Any]] = ()
    package_paths: Sequence[str] = ()
    _running: list[_NodeProcess] = field(default_factory=list)
    _failures: list[str] = field(default_factory=list)

    @property
    def is_watched(self) -> bool:
        """True: processes follow wall time, so that the run has at most the speed of real time."""
        return bool(self.nodes)

    @contextmanager
    def around_loop(self, run: OpenRun) -> Iterator[None]:
        """Start the processes during the loop, and end them after it.

        Raises:
            InputError: SK-LAUNCH-045 the run has no socket for other processes.
            NodeError: SK-SCEN-010 a process ended with another exit code than 0.
        """
        if self.nodes and run.loop.server is None:
            raise InputError("SK-LAUNCH-045", "processes need local sockets, which this system lacks")
        self._running = [_NodeProcess(node_arguments(node)) for node in self.nodes]
        run.loop.watchers.append(lambda: self._look_after(run))
        try:
            self._look_after(run)
            self._wait_for_connections(run)
            yield
        finally:
            self._end()
        if self._failures:
            raise NodeError(self._failures)

    def _wait_for_connections(self, run: OpenRun) -> None:
        """Wait until the first processes have connected, so that they see the begin of the run."""
        server, until = run.loop.server, time.monotonic() + _START_TIMEOUT
        while server is not None and not run.interrupts.exit_code and time.monotonic() < until:
            living = [one for one in self._running if one.process is not None and one.process.poll() is None]
            if len(server.peers) >= len(living):
                return
            server.poll(_POLL)

    def _look_after(self, run: OpenRun) -> None:
        for each in self._running:
            if each.process is not None and each.process.poll() is not None:
                self._meet_end(each, each.process.returncode, run)
            if each.due is None and not each.is_over and self._holds(each, run):
                each.due = run.sim.time + float(each.node.get("delay", 0.0))
            if each.due is not None and each.process is None and not each.is_over and run.sim.time >= each.due:
                self._start(each, run)

    def _holds(self, each: _NodeProcess, run: OpenRun) -> bool:
        """Check whether the condition for the start of a node holds."""
        for event, label in dict(each.node.get("after", {})).items():
            other = next((one for one in self._running if one.label == label), None)
            if other is not None:
                return other.is_over if event == "exit" else other.process is not None
            program = next((one for one in run.sim.nodes if one.label == label), None)
            if program is not None:
                return program.done if event == "exit" else program.hand_overs > 0
        return True

    def _start(self, each: _NodeProcess, run: OpenRun) -> None:
        server = run.loop.server
        assert server is not None
        words = [word for folder in self.package_paths for word in ("--package-path", folder)]
        words += ["--sim", server.name, str(each.node["program"]), *node_words(each.node)]
        environment = {**os.environ, **each.node.get("env", {})}
        command = [sys.executable, "-m", "simkit", "node", "run", *words]
        each.process = subprocess.Popen(command, env=environment, cwd=each.node.get("cwd"))
        print_status(f"[{each.label}]: process started with pid {each.process.pid}")

    def _meet_end(self, each: _NodeProcess, code: int, run: OpenRun) -> None:
        """Report the end of a process; start it again, or end the run, if the launch file says so."""
        print_message(f"[{each.label}]: process has ended with exit code {code}")
        each.process, respawn = None, each.node.get("respawn")
        if respawn is not None:
            each.due = run.sim.time + float(respawn)
            return
        each.is_over = True
        self._note_failure(each, code)
        if each.node.get("ends_run"):
            run.loop.early_ends.append(lambda: f"the end of {each.label}")

    def _note_failure(self, each: _NodeProcess, code: int) -> None:
        if code:
            self._failures.append(f"{each.label!r} ended with exit code {code}")

    def _end(self) -> None:
        """End all processes as Ctrl-C does; those that stay are killed."""
        processes = []
        for each in self._running:
            if each.process is not None and each.process.poll() is None:
                each.process.send_signal(signal.SIGINT if os.name != "nt" else signal.SIGTERM)
                processes.append(each.process)
            elif each.process is not None:
                self._note_failure(each, each.process.returncode)
        for process in processes:
            try:
                process.wait(_GRACE)
            except subprocess.TimeoutExpired:
                kill_process_tree(process)


def node_words(node: Mapping[str, Any]) -> list[str]:
    """Return the command line of a node, as after its program: its arguments, names, remaps and parameters."""
    words = list(node.get("args", ()))
    rules = [("-r", f"{old}:={new}") for old, new in dict(node.get("remap", {})).items()]
    for option, value in (("__node", node.get("name")), ("__ns", node.get("namespace"))):
        if value:
            rules.append(("-r", f"{option}:={value}"))
    rules += [("-p", f"{name}:={json.dumps(value)}") for name, value in flat_values(dict(node.get("params", {})))]
    if rules:
        words += [ROS_ARGUMENTS, *(word for rule in rules for word in rule)]
    return words


def split_processes(spec: RunSpec) -> tuple[RunSpec, NodeProcesses]:
    """Return a run without the user's own nodes, and the part that starts those as processes."""
    own = [node for node in spec.nodes if known_node(str(node_arguments(node)["program"])) is None]
    kept = tuple(node for node in spec.nodes if node not in own)
    paths = [str(path) for path in spec.options.get("package_paths", ())]
    return replace(spec, nodes=kept), NodeProcesses([node_arguments(node) for node in own], paths)
