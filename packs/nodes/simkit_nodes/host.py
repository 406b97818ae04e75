"""World around a program, as the modules of ROS need it: time, waiting, threads and the communication graph."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final, Protocol

from simkit_nodes.tasks import current_task

if TYPE_CHECKING:
    from simkit import Simulation
    from simkit_nodes.graph import Graph
    from simkit_nodes.programs import NodeProgram


class Host(Protocol):
    """World around a program.

    In lock-step, all times are simulated. In a process of its own, `now_ns` is the system's clock.

    Attributes:
        graph: topics, services and actions.
    """

    graph: Graph

    @property
    def simulation(self) -> Simulation | None:
        """Simulation around the program; None in a process of its own."""

    def now_ns(self) -> int:
        """Return the time of the system's clock [ns]; in lock-step the simulated time."""

    def wait(self, until_ns: int | None = None, is_ready: Callable[[], bool] | None = None) -> None:
        """Wait until a time of `now_ns` or until a condition holds; None for no such end.

        The condition is asked again after `wake`, and after another thread of a program has waited.

        Raises:
            KeyboardInterrupt, ProgramEnd: the program shall end.
        """

    def poll(self) -> None:
        """Count a question that does not wait, such as `rclpy.ok()`; a loop of such questions gets a step."""

    def wake(self) -> None:
        """Have the conditions of all waits asked again, because something has happened."""

    def call_outside(self, function: Callable[[], object]) -> Any:
        """Call a function that changes the world in the thread of the simulation, and return its result."""

    def start_thread(self, function: Callable[[], object], name: str) -> Any:
        """Start a thread of the present program; the result has `is_done` and `ident`."""

    def seed_of(self, node: str) -> int:
        """Return the seed of the random numbers of a node."""


PROGRAM_OF_PROCESS: Final[list[NodeProgram]] = []
"""Only program of a process that runs one; empty in a process with a simulation."""


def current_program() -> NodeProgram:
    """Return the program that runs now.

    Raises:
        RuntimeError: the calling thread belongs to no program.
    """
    task = current_task()
    if task is not None:
        return task.program
    if PROGRAM_OF_PROCESS:
        return PROGRAM_OF_PROCESS[0]
    raise RuntimeError("this thread belongs to no program that simkit runs; start it with sim.add_node or --node")


def current_host() -> Host:
    """Return the world around the present program; see `current_program`."""
    return current_program().host
