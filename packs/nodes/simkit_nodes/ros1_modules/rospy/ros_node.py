"""State of the ROS 1 node of a program: its name, its remappings, its shutdown and its waits."""

from __future__ import annotations

import itertools
import re
import signal
import sys
import traceback
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final

from simkit.in_process import InProcess
from simkit_nodes import ros1_names as names
from simkit_nodes.host import current_program
from simkit_nodes.parameter_overrides import ros1_parameters
from simkit_nodes.ros1_modules.rospy.exceptions import ROSInitException, ROSInterruptException
from simkit_nodes.ros1_parameters import ParameterServer, parameter_server
from simkit_nodes.tasks import ProgramEnd

if TYPE_CHECKING:
    from simkit_nodes.graph import GraphNode
    from simkit_nodes.programs import NodeProgram

MAX_WAITS_AT_END: Final = 20
"""Largest number of waits of functions of `on_shutdown` after the end of the run; no time passes in them."""

_UNNAMED: Final = "unnamed"
_ANONYMOUS: Final = "ROS 1 numbers of anonymous names"


class RosNode(InProcess):
    """The ROS 1 node of a program; a program has one.

    Args:
        program: program of the node.

    Attributes:
        program: program of the node.
        host: world around the program.
        name: full name, such as `/robot/follower`.
        namespace: namespace with a slash at the end.
        mappings: new names by old ones, as on the command line.
        parameters: parameter server, which all programs share.
        arguments: arguments of `init_node`; None before it.
        is_initialized: True after `init_node`.
        is_shutting_down: True from the beginning of the shutdown on.
        is_shutdown: True after the functions of `on_shutdown` have been called.
    """

    def __init__(self, program: NodeProgram) -> None:
        self.program, self.host = program, program.host
        self.namespace = names.GLOBALNS
        self.mappings: dict[str, str] = {}
        self._resolved: dict[str, str] = {}
        self.load_mappings(sys.argv)
        self.name = self.namespace + _UNNAMED
        self.parameters: ParameterServer = parameter_server(self.host)
        self._parameter_values = _parameters_of_run(program)
        for name, value in self._parameter_values.items():
            if not names.is_private(name):
                self.parameters.set(self.resolve(name), value)
        self.arguments: tuple[object, ...] | None = None
        self.is_initialized = self.is_shutting_down = self.is_shutdown = False
        self._handles_signals = self._is_interrupted = False
        self._waits_at_end = 0
        self._graph_node: GraphNode | None = None
        self._at_init: list[Callable[[], None]] = []
        self.shutdown_functions: list[Callable[[], object]] = []
        program.exit_functions.append((self.shut_down, ("atexit",), {}))

    # ------------------------------------------------------------------ names

    def load_mappings(self, argv: list[str]) -> None:
        """Read the remappings of a command line; those of the run come before them."""
        options, arguments = self.program.options, self.program.ros_arguments
        rules = {rule.old: rule.new for rule in arguments.rules if rule.old and not rule.node}
        self.mappings = {**names.load_mappings(argv), **rules, **options.remap}
        name = options.name or arguments.node_name("")
        if name:
            self.mappings["__name"] = name
        namespace = names.get_ros_namespace(argv=argv)
        self.namespace = names.make_global_ns(options.namespace or arguments.namespace("", namespace))

    def anonymous_name(self, base: str) -> str:
        """Return a name that differs at each call, also of other programs, but not from run to run.

        The name of a program that has a process of its own differs in each process.
        """
        numbers = self.host.graph.shared.setdefault(_ANONYMOUS, itertools.count(1))
        assert isinstance(numbers, itertools.count)
        program = re.sub(r"\W", "_", self.program.name)
        return f"{base}_{program}_{next(numbers)}"

    def resolve(self, name: str, caller_id: str | None = None) -> str:
        """Return the global form of a name after the remappings."""
        return names.resolve_name(str(name), caller_id or self.name, self._resolved)

    def resolve_endpoint(self, name: str) -> str:
        """Return the global form of the name of a topic or a service.

        Raises:
            ValueError: the name is private, and the node has no name yet.
        """
        if self.is_initialized:
            return self.resolve(name)
        if names.is_private(name):
            raise ValueError("~name topics cannot be created before init_node() has been called")
        self._resolve_mappings()
        return self.resolve(name)

    def _resolve_mappings(self) -> None:
        self._resolved = {
            names.resolve_name(old, self.name): names.resolve_name(new, self.name)
            for old, new in self.mappings.items()
            if not old.startswith("__")
        }

    # ------------------------------------------------------------------ start

    def begin(self, name: str, *, handles_signals: bool) -> None:
        """Give the node its name, and open what was created before.

        Args:
            name: name of the node, without the namespace.
            handles_signals: True if the end of the run shuts the node down.
        """
        self._handles_signals = handles_signals
        if handles_signals:  # then a wait of the main thread goes on, and the program sees that the node is shut down
            self.program.signal_handlers[signal.SIGINT] = self._on_signal
        self.name = names.resolve_name(name, self.namespace + _UNNAMED)
        self._resolve_mappings()
        self._graph_node = self.host.graph.open_node(self.program, self.name)
        for parameter, value in self._parameter_values.items():
            if not names.is_global(parameter):  # a launch file sets it inside of <node>, where it is private
                self.parameters.set(self.resolve(f"~{parameter.removeprefix('~')}"), value)
        self.is_initialized = True
        functions, self._at_init = self._at_init, []
        for function in functions:
            function()

    def at_init(self, function: Callable[[], None]) -> None:
        """Call a function when the node has its name: at once after `init_node`."""
        if self.is_initialized:
            function()
        else:
            self._at_init.append(function)

    @property
    def graph_node(self) -> GraphNode:
        """Node in the communication graph; a program without `init_node` has one without a name of its own."""
        if self._graph_node is None:
            self._graph_node = self.host.graph.open_node(self.program, self.namespace + self.anonymous_name(_UNNAMED))
        return self._graph_node

    def check_is_initialized(self) -> None:
        """Check that the program has called `init_node`.

        Raises:
            ROSInitException: it has not.
        """
        if not self.is_initialized:
            raise ROSInitException("time is not initialized. Have you called init_node()?")

    # ------------------------------------------------------------------ waits

    def wait(self, until_ns: int | None = None, is_ready: Callable[[], bool] | None = None) -> None:
        """Wait until a time [ns], until a condition holds or until the node is shut down.

        At the end of the run, the wait shuts the node down, as Ctrl-C does.
        """
        ends = (lambda: self.is_shutdown) if is_ready is None else (lambda: self.is_shutdown or is_ready())
        try:
            self.host.wait(until_ns, ends)
        except KeyboardInterrupt:
            self._interrupt()

    def poll(self) -> None:
        """Count a question that does not wait; see `Host.poll`."""
        try:
            self.host.poll()
        except KeyboardInterrupt:
            self._interrupt()

    def _on_signal(self, number: int, frame: object) -> None:
        self._interrupt()

    def _interrupt(self) -> None:
        """Shut the node down because of Ctrl-C or the end of the run."""
        if not self._handles_signals:
            raise KeyboardInterrupt
        if not self._is_interrupted:
            self._is_interrupted = True
            self.shut_down("signal-2")
            return
        self._waits_at_end += 1
        if self._waits_at_end > MAX_WAITS_AT_END:
            raise ProgramEnd

    def sleep(self, duration_ns: int) -> None:
        """Wait for a duration [ns].

        Raises:
            ROSInterruptException: the node was shut down.
        """
        if duration_ns > 0:
            self.wait(self.host.now_ns() + duration_ns)
        else:
            self.poll()
        if self.is_shutdown:
            raise ROSInterruptException("ROS shutdown request")

    # ------------------------------------------------------------------ shutdown

    def shut_down(self, reason: str) -> None:
        """Call the functions of `on_shutdown`, and end all waits of the node."""
        if self.is_shutting_down:
            return
        self.is_shutting_down = True
        functions, self.shutdown_functions = self.shutdown_functions, []
        for function in functions:
            try:
                function()
            except Exception:  # noqa: BLE001 - as in rospy, the other functions are called all the same
                self.program.write_log(traceback.format_exc().splitlines())
        self.is_shutdown = True
        if self._graph_node is not None:
            self._graph_node.close()
        self.host.wake()

    def start_thread(self, function: Callable[[], object], name: str) -> Any:
        """Start a thread that ends with the node."""

        def run() -> None:
            try:
                function()
            except ROSInterruptException:
                if not self.is_shutdown:
                    raise

        return self.host.start_thread(run, name)


def _parameters_of_run(program: NodeProgram) -> dict[str, Any]:
    """Return the parameters of the run by the names that the program has for them."""
    return {**ros1_parameters(program.ros_arguments), **program.options.params}


def ros_node() -> RosNode:
    """Return the ROS 1 node of the present program."""
    program = current_program()
    node = program.data.get("rospy")
    if node is None:
        node = program.data["rospy"] = RosNode(program)
    assert isinstance(node, RosNode)
    return node
