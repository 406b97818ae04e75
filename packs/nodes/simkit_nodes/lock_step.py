"""Programs in lock-step with a simulation: they run between two steps, while simulated time stands still."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Mapping, Sequence
from contextvars import Context, copy_context
from copy import copy
from functools import partial
from typing import TYPE_CHECKING, Final, TypeVar

from simkit.diagnostics import name_hint
from simkit.errors import InputError
from simkit_nodes.graph import Graph
from simkit_nodes.known_nodes import KnownNode
from simkit_nodes.node_options import Keys, NodeOptions
from simkit_nodes.programs import NodeProgram, program_source
from simkit_nodes.ros1_parameters import ParameterServer, parameter_server, set_run_parameters
from simkit_nodes.simulation_topics import SimulationTopics
from simkit_nodes.task_host import TaskHost
from simkit_nodes.tasks import TaskScheduler, current_task, deadlocked_tasks

if TYPE_CHECKING:
    from simkit import Simulation

R = TypeVar("R")

_MOST_PLAIN_STEPS: Final = 16
"""Largest number of steps at once in the thread of a program: Ctrl-C and the end of the process wait for them."""

_DENORMAL: Final = 5e-324
_CONDITION: Final = "SK-NODE-065"
_LEAST_RESPAWN: Final = 1.0  # [s] after which a program starts again that has ended without simulated time
_NO_SNAPSHOT: Final = "a snapshot does not contain the nodes: after a restore they continue from where they are"


class LockStep(TaskHost):
    """All programs of a simulation, and the world around them.

    Args:
        sim: simulation.

    Attributes:
        programs: programs in the order in which they were added.
        graph: topics, services and actions.
        tasks: scheduler of the programs' threads.
        ended_by: name of the program whose end has ended the run; empty before.
    """

    def __init__(self, sim: Simulation) -> None:
        self._sim = sim
        self.programs: list[NodeProgram] = []
        self._loads_controllers = False
        self._waiting: list[NodeProgram] = []  # for the condition of their start, in the order of addition
        self._awaited: dict[NodeProgram, tuple[str, NodeProgram | None]] = {}
        self._caller: NodeProgram | None = None
        self.ended_by = ""
        self.tasks = TaskScheduler(self.now_ns)
        messages = sim.communication
        self.graph = Graph(
            SimulationTopics(sim), messages.services, messages.actions, messages.bus.enqueue, self, self.run_now
        )

    # ------------------------------------------------------------------ world around the programs

    @property
    def simulation(self) -> Simulation:
        """Simulation, which a program in a pack may change between steps: spawn, remove, end the run."""
        return self._sim

    def now_ns(self) -> int:
        """Return the simulated time [ns]."""
        return self._sim.engine.time_ns

    def wake(self) -> None:
        """Have the conditions of all waits asked again at the present tick."""
        self.tasks.needs_look = True
        self._sim.engine.loop.interrupt()

    def call_outside(self, function: Callable[[], R]) -> R:
        """Call a function that changes the world, such as a spawn, in the thread of the simulation.

        A program has its own modules, folder and environment, which the function must not see. For a caller that is no
        program, the function is called directly.
        """
        task = current_task()
        return function() if task is None else task.call_outside(partial(self._call_for, task.program, function))

    def _call_for(self, program: NodeProgram, function: Callable[[], R]) -> R:
        """Call a function for a program; the programs that it adds belong to this one."""
        self._caller = program
        try:
            return function()
        finally:
            self._caller = None

    def seed_of(self, node: str) -> int:
        """Return the seed of the random numbers of a node: a function of the run's seed and the node's name."""
        digest = hashlib.sha256(f"{self._sim.seed}:{node}".encode()).digest()
        return int.from_bytes(digest[:8], "little")

    # ------------------------------------------------------------------ programs of the simulation

    def add(
        self,
        program: str | os.PathLike[str] | Callable[[], object],
        *,
        name: str | None = None,
        namespace: str | None = None,
        remap: Mapping[str, str],
        params: Mapping[str, object],
        args: Sequence[str] = (),
        latency: float | tuple[float, float] = 0.0,
        discovery: float = 0.0,
        limit: float = 60.0,
        restart: float | None = None,
        keys: Keys | None = None,
        label: str | None = None,
        after: Mapping[str, str] | None = None,
        delay: float = 0.0,
        respawn: float | None = None,
        ends_run: bool = False,
        env: Mapping[str, str] | None = None,
        cwd: str | os.PathLike[str] | None = None,
    ) -> NodeProgram:
        """Add a program; it starts with the next step, or when its condition holds. See `Simulation.add_node`."""
        spec = self._sim.run_spec
        package_paths = () if spec is None else spec.options.get("package_paths", ())
        source = program if callable(program) else program_source(program, package_paths, self.graph.shared)
        if isinstance(source, KnownNode) and source.nothing:
            self._sim.engine.reports.note("SK-NODE-064", f"{source.name} has no effect here: {source.nothing}")
        files = self._run_parameter_files()
        options = NodeOptions(
            name=name,
            namespace=namespace,
            remap=copy(remap),
            params=copy(params),
            args=(*files, *args) if files and not isinstance(args, str) else copy(args),
            latency=latency,
            discovery=discovery,
            limit=limit,
            restart=restart,
            keys=keys,
            label=label,
            after=copy(after or {}),
            delay=delay,
            respawn=respawn,
            ends_run=ends_run,
            env=copy(env or {}),
            cwd=None if cwd is None else os.fspath(cwd),
            package_paths=package_paths,
        )
        if label is not None and any(label == other.options.label for other in self.programs):
            raise InputError(_CONDITION, f"two nodes have the label {label!r}", help="give each node another label")
        added = NodeProgram(self, source, options, self._sim.engine.reports)
        added.added_by = self._caller
        self.programs.append(added)
        if added.known is not None and added.known.is_loading_controllers(args):
            self._loads_controllers = True
        self._prepare_start(added)
        return added

    def _run_parameter_files(self) -> tuple[str, ...]:
        """Return the arguments with the parameter files of the run (`--params-file`) for all models, as for ROS 2."""
        files = self._sim.engine.structure.builder.parameter_files
        paths = [item.file.path for item in files if not item.model and item.file.root is None]
        if not paths:
            return ()
        reports, names = self._sim.engine.reports, {str(path) for path in paths}
        reports.drop([item for item in reports if item.code == "SK-CONTROL-060" and item.file in names])
        return ("--ros-args", *(word for path in paths for word in ("--params-file", str(path))), "--")

    def set_parameters(self, values: Mapping[str, object]) -> None:
        """Set parameters of ROS 1 for all programs. See `Simulation.set_ros_parameters`."""
        set_run_parameters(self, values)

    @property
    def parameters(self) -> ParameterServer:
        """Parameter server of ROS 1, which clients in other processes use, too."""
        return parameter_server(self)

    def _prepare_start(self, program: NodeProgram) -> None:
        """Start a program, or let it wait for the condition of its start."""
        program.begin_ns = self.now_ns()
        program.event_ns.clear()
        if program.options.after or program.options.delay:
            self._waiting.append(program)
            if self._caller is not None:  # a run is going on
                self._find_awaited()
        else:
            self._start(program)

    def _start(self, program: NodeProgram) -> None:
        program.started_ns = self.now_ns()
        program.event_ns.setdefault("start", program.started_ns)
        program.main_task = self.tasks.create(program, program.run, program.name)

    def advance(self, target: int, advance: Callable[[int], None]) -> None:
        """Call `advance` up to the tick `target`, and run the programs at the ticks for which they wait."""
        _check_outside("step")
        if self._waiting:
            self._find_awaited()  # nodes may have been added
        if self._loads_controllers and not self._sim.control.has_controller_nodes:
            self._sim.control.leave_controllers_to_nodes()  # here, and not in `add`: a bundle has an entry for it
        sim, tasks = self._sim, self.tasks
        end = sim.engine.steps + target - sim.tick
        make_plain_steps = partial(self._make_plain_steps, end, copy_context())
        while True:
            tasks.make_plain_steps = make_plain_steps
            try:
                self._run_programs()
            finally:
                tasks.make_plain_steps = None
            stop = self._next_stop(end)
            if stop <= sim.tick or (self.ended_by and sim.control.pausing.is_served):
                return
            goal = sim.engine.steps + stop - sim.tick
            advance(stop)
            if sim.engine.steps < goal and not tasks.needs_look:
                return  # the run was halted

    def _next_stop(self, end: int) -> int:
        """Return the next tick at which a program may have to run, up to a number of steps since the load."""
        sim = self._sim
        tick = sim.tick
        stop, next_ns = tick + end - sim.engine.steps, _earliest(self.tasks.next_ns, self.graph.next_ns)
        if self._waiting:
            next_ns = _earliest(next_ns, self._next_start_ns())
        if next_ns is not None:
            stop = min(stop, max(tick + 1, sim.engine.clock.tick_at(next_ns)))
        return stop

    def _make_plain_steps(self, end: int, context: Context) -> bool:
        """Make the steps up to the next wait's end in the thread of a program, if only the physics runs in them.

        A program may have changed the numbers of its thread: with denormal numbers as zero, as some compiled packages
        set it, the physics would have other bits. The settings of NumPy belong to the context.

        Args:
            end: number of steps since the load at which the run ends.
            context: context of the thread that runs the simulation.
        """
        sim, next_ns = self._sim, self.graph.next_ns
        if self._waiting:
            next_ns = _earliest(next_ns, self._next_start_ns())
        tick, stop = sim.tick, self._next_stop(end)
        is_possible = (
            tick < stop <= tick + _MOST_PLAIN_STEPS
            and not self.tasks.visited
            and (next_ns is None or next_ns > sim.engine.clock.time_ns(stop))
            and sim.communication.bus.journal is None
            and _DENORMAL * 1.0 > 0.0
        )
        return is_possible and context.run(sim.engine.loop.advance_physics, stop)

    def run_now(self) -> None:
        """Run the programs without a step, for a call of a script or a tool."""
        if self._waiting:
            self._find_awaited()
        self.tasks.count_turns_anew()
        self._run_programs()

    def _run_programs(self) -> None:
        has_started = True
        while has_started:
            if self._waiting:
                self._start_due()
            try:
                self.graph.deliver()
                self.tasks.run_ready()
            finally:
                self.tasks.leave_program()
            if self.tasks.visited:
                self._look_after_visited()
            next_ns = self._next_start_ns() if self._waiting else None
            has_started = next_ns is not None and next_ns <= self.now_ns()  # a program waits for the end of another one

    def _look_after_visited(self) -> None:
        """End and restart programs whose threads have ended, and end the run with a program that ends it."""
        visited, self.tasks.visited = self.tasks.visited, set()
        for program in self.programs:
            if program in visited and not program.done:
                self._look_after(program)
            if program not in visited or not program.done or self.ended_by:
                continue
            if program.options.ends_run:
                self._end_run(program)
            elif program.options.respawn is not None:
                self._start_again(program, program.options.respawn)
            elif program.error is not None and program.options.restart is not None:
                self._start_again(program, program.options.restart)

    # ------------------------------------------------------------------ conditions for the start

    def _start_due(self) -> None:
        """Start the programs whose condition holds, in the order in which they were added."""
        has_started = True
        while has_started:
            has_started, now = False, self.now_ns()
            for program in tuple(self._waiting):
                due_ns = self._due_ns(program)
                if due_ns is not None and due_ns <= now:
                    self._waiting.remove(program)
                    self._start(program)
                    has_started = True  # another program may wait for this start

    def _next_start_ns(self) -> int | None:
        """Return the simulated time of the next start of a program that waits [ns]; None if none is known."""
        times = [due_ns for due_ns in map(self._due_ns, self._waiting) if due_ns is not None]
        return min(times) if times else None

    def _due_ns(self, program: NodeProgram) -> int | None:
        """Return the simulated time at which a program starts [ns]; None while the event is not there."""
        event, other = self._awaited[program]
        begin_ns = program.begin_ns if other is None else other.event_ns.get(event)
        return None if begin_ns is None else begin_ns + round(program.options.delay * 1e9)

    def _find_awaited(self) -> None:
        """Find the programs for whose events others wait; a run asks for them at each stop.

        Raises:
            InputError: SK-NODE-065 no node has the label, or several nodes have this name and none has the label.
        """
        self._awaited = dict.fromkeys(self._waiting, ("", None))
        for program in self._waiting:
            for event, label in program.options.after.items():
                others = [each for each in self.programs if each.options.label == label]
                others = others or [each for each in self.programs if each.label == label]
                if len(others) != 1:
                    raise self._label_error(f"node {program.name!r} waits for the {event} of a node", label, others)
                self._awaited[program] = event, others[0]

    def _label_error(self, problem: str, label: str, others: Sequence[NodeProgram]) -> InputError:
        """Return the error for a label that no node has, or that several nodes have as their name."""
        if others:
            hint = "give one of them a `label`"
            return InputError(_CONDITION, f"{problem}: several nodes have the name {label!r}", help=hint)
        hint = name_hint(label, list(dict.fromkeys(each.label for each in self.programs)))
        return InputError(_CONDITION, f"{problem}: no node has the label {label!r}", help=hint)

    def _end_run(self, program: NodeProgram) -> None:
        """End all programs, and a run that is kept going by simkit; a script goes on without programs."""
        self.ended_by = program.name
        self._waiting.clear()
        for other in self.programs:
            self._end(other)
        if self._sim.control.pausing.is_served:
            self._sim.control.pausing.end()

    def _look_after(self, program: NodeProgram) -> None:
        """End what is left of a program whose main thread has ended, and report threads that wait for each other."""
        tasks = self.tasks.tasks_of(program)
        if tasks and (program.main_task.is_done or program.is_exiting):
            self._end(program)  # its threads are daemons
        elif not tasks:
            self._close(program)
        elif any(task.waits_for is not None for task in tasks):
            deadlocked = deadlocked_tasks(tasks)
            if deadlocked:
                program.note_deadlock(deadlocked)

    def _close(self, program: NodeProgram) -> None:
        program.stdout.end_line()
        program.stderr.end_line()
        program.done = True
        if program.is_started:
            program.event_ns.setdefault("exit", self.now_ns())
        self.graph.close_program(program)

    def _start_again(self, program: NodeProgram, delay: float) -> None:
        """Start a program that has ended again, after a simulated time [s] of at least a step; its log continues.

        A program that needed no simulated time, such as one that cannot import a module, waits at least a second: it
        would otherwise start in each step.
        """
        if self.now_ns() == program.started_ns:
            delay = max(delay, _LEAST_RESPAWN)
        lines = list(program.log)
        program.prepare()
        program.log[:] = lines
        program.restarts += 1
        self._start(program)
        program.main_task.until_ns = program.started_ns = self._tick_ns_after(delay)

    def _tick_ns_after(self, delay: float) -> int:
        """Return the simulated time of the first tick after a delay [s] [ns]; at least one step from now."""
        clock = self._sim.engine.clock
        return clock.time_ns(clock.tick_at(self.now_ns() + max(1, round(delay * 1e9))))

    def end(self) -> None:
        """End all programs, before a reset."""
        _check_outside("reset or close")
        for program in self.programs:
            self._end(program)
        self.graph.clear()

    def restart(self) -> None:
        """Start all programs anew, after a reset."""
        if self.ended_by:
            self.ended_by, self._sim.control.pausing.is_over = "", False
        self._waiting.clear()
        self.programs = [program for program in self.programs if program.added_by is None]  # these add the others again
        for program in self.programs:
            program.prepare()
            program.restarts = 0
            self._prepare_start(program)

    def follow_restore(self, before_ns: int) -> None:
        """Continue the programs after a restore; they wait as long as before.

        Args:
            before_ns: simulated time before the restore [ns].
        """
        self.note_snapshot()
        duration_ns = self.now_ns() - before_ns
        self.tasks.shift(duration_ns)
        self.graph.follow_jump(duration_ns)
        for program in self.programs:
            program.begin_ns += duration_ns
            program.started_ns += duration_ns
            program.event_ns = {event: time_ns + duration_ns for event, time_ns in program.event_ns.items()}

    def note_snapshot(self) -> None:
        """Report that a snapshot does not contain the programs."""
        if any(not program.done for program in self.programs):
            self._sim.engine.reports.note("SK-NODE-057", _NO_SNAPSHOT, hint="use reset, which starts them anew")

    def close(self) -> None:
        """End all programs."""
        self.end()

    def _end(self, program: NodeProgram) -> None:
        if program.done:
            return
        try:
            self.tasks.end(program)
        finally:
            self.tasks.leave_program()
        self._close(program)


def _check_outside(action: str) -> None:
    """Raise InputError if a program itself calls a function that runs or ends the programs."""
    if current_task() is not None:
        help_ = "let the node wait, such as with time.sleep(0.1)"
        raise InputError("SK-NODE-002", f"a node cannot {action} the simulation", help=help_)


def _earliest(first: int | None, second: int | None) -> int | None:
    """Return the earlier of two times; None is no time."""
    if first is None or second is None:
        return second if first is None else first
    return min(first, second)
