"""Tasks: threads of programs of which only one runs at a time, and only while simulated time stands still.

A task is a thread of the operating system. It runs while it has the turn, until it waits for a simulated time or a
condition. Then the scheduler gives the turn to the next task whose wait has ended, in the order in which tasks were
created. When all tasks wait, the simulation makes steps.

A task that waits gives the turn to the next task itself, because a change of the thread takes 4 µs or more. The thread
that steps the simulation gets the turn when all tasks wait; steps in which only the physics runs are made without it.
"""

from __future__ import annotations

import _thread
import ctypes
import sys
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from math import inf
from time import monotonic
from types import FrameType
from typing import TYPE_CHECKING, Any, Final, TypeVar

from simkit.in_process import InProcess
from simkit_nodes.turn_signal import TurnSignal

if TYPE_CHECKING:
    from simkit_nodes.programs import NodeProgram

R = TypeVar("R")

MAX_TURNS: Final = 100
"""Largest number of turns of a task at one simulated time; the next turn comes after a step."""

MAX_POLLS: Final = 20
"""Largest number of questions for the time or the state that a task asks without waiting; then it waits for a step."""

MAX_ENDINGS: Final = 50
"""Largest number of times that a task is asked to end; a program may catch all exceptions."""

MAX_ENDED_WAITS: Final = 20
"""Largest number of waits for a time that a task may make while it ends, such as a pause in a `finally` block."""

_SIGNAL_PERIOD: Final = 0.2  # [s] of wall time between two looks for Ctrl-C where it does not end the wait for a lock

_GRACE: Final = 2.0  # [s] of wall time that a task gets to end after an exception was raised in its thread


class ProgramEnd(BaseException):
    """End of a task's program, raised where the task waits; derived from BaseException like SystemExit."""


class ProgramStuck(BaseException):
    """End of a task that has computed for too long without waiting."""


class Task(InProcess):
    """Thread of a program.

    Args:
        scheduler: scheduler that gives the turn.
        program: program of the thread.
        function: function that the thread calls.
        name: name of the thread.
        number: 1, 2, … in the order of creation.

    Attributes:
        number: number of the task, which is the thread's identifier for its program.
        until_ns: simulated time at which the wait ends [ns]; None for no such time.
        is_ready: function that returns True when the wait ends; None for no condition.
        waits_for: task that holds the lock for which this task waits without a time limit; None without such a wait.
        is_done: True after the end of the function.
        is_ending: True after the task was asked to end.
        is_asked_to_end: True if the next wait raises an exception.
        is_abandoned: True if the task did not end although it was asked to; its thread goes on alone.
        on_end: functions that are called at the end of the task.
        request: function that the scheduler calls for the task, outside of its program; None without one.
    """

    def __init__(
        self, scheduler: TaskScheduler, program: NodeProgram, function: Callable[[], object], name: str, number: int
    ) -> None:
        self._scheduler, self.program, self._function, self.name = scheduler, program, function, name
        self.number = number
        self.until_ns: int | None = 0
        self.is_ready: Callable[[], bool] | None = None
        self.waits_for: Callable[[], Task | None] | None = None
        self.is_done = self.is_ending = self.is_abandoned = self.is_started = False
        self.is_asked_to_end = False
        self.on_end: list[Callable[[], None]] = []
        self.turn = TurnSignal()
        self.polls = self.ended_waits = 0
        self.request: Callable[[], object] | None = None
        self._answer: Callable[[], object] = _no_answer
        self.turns = (-1, 0)
        self._thread_id = 0

    @property
    def ident(self) -> int:
        """Identifier of the thread for its program; the same in every run, unlike that of the operating system."""
        return self.number

    def begin(self) -> None:
        """Start the thread; it waits for its first turn."""
        self.is_started = True
        _thread.start_new_thread(self._run, ())

    def _run(self) -> None:
        self._thread_id = _thread.get_ident()
        self.turn.wait()
        TASKS[self._thread_id] = self
        try:
            if not self.is_ending:
                self._function()
        except (ProgramEnd, SystemExit):
            pass
        except BaseException as error:  # noqa: BLE001 - a program may raise anything
            self.program.meet(self, error)
        finally:
            for function in self.on_end:
                function()
            self.is_done = True
            del TASKS[self._thread_id]
            self._scheduler.take_back(self)

    def wait(self, until_ns: int | None = None, is_ready: Callable[[], bool] | None = None) -> None:
        """Give the turn back until a simulated time [ns] or until a condition holds; None for no such end.

        Raises:
            KeyboardInterrupt: the program shall end, and this is its main thread.
            ProgramEnd: the program shall end, and this is another thread.
        """
        if self.is_abandoned:
            raise ProgramEnd
        self.until_ns, self.is_ready, self.polls = until_ns, is_ready, 0
        if not self._scheduler.take_back(self):
            self.turn.wait()
        self.is_ready = None
        if self.is_asked_to_end:
            self.is_asked_to_end = False
            self.program.interrupt(self)

    def call_outside(self, function: Callable[[], R]) -> R:
        """Call a function in the thread of the scheduler, with the values of the process, and return its result.

        The task then goes on at once: no other task gets the turn in between.
        """
        if self.is_abandoned:
            raise ProgramEnd
        self.request, self._answer = function, _no_answer
        if not self._scheduler.take_back(self):
            self.turn.wait()
        answer: Callable[[], R] = self._answer
        return answer()

    def answer_request(self) -> None:
        """Call the function that the task has requested; the task receives its result or its exception."""
        function, self.request = self.request, None
        assert function is not None
        try:
            result = function()
        except Exception as error:  # noqa: BLE001 - the program may catch it
            self._answer = partial(_raise, error)
        else:
            self._answer = lambda: result

    def poll(self) -> None:
        """Count a question that does not wait; a loop that only asks waits for a step after some of them."""
        self.polls += 1
        if self.polls > MAX_POLLS:
            self.wait(self._scheduler.now_ns() + 1)

    @property
    def frame(self) -> FrameType | None:
        """Innermost frame of the thread; None before its start and after its end."""
        return sys._current_frames().get(self._thread_id)

    def raise_in_thread(self, error: type[BaseException]) -> None:
        """Raise an exception in the thread, at its next line of Python."""
        ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(self._thread_id), ctypes.py_object(error))


def _no_answer() -> Any:
    """Raise ProgramEnd, for a request that an interrupt has ended."""
    raise ProgramEnd


def _raise(error: Exception) -> Any:
    raise error


TASKS: Final[dict[int, Task]] = {}
"""Started tasks by the identifier of their thread."""


def current_task() -> Task | None:
    """Return the task of the calling thread; None for any other thread."""
    return TASKS.get(_thread.get_ident())


class TaskScheduler:
    """Scheduler of the tasks of all programs of a simulation.

    Args:
        now_ns: function that returns the simulated time [ns].

    Attributes:
        hand_overs: number of turns given.
        needs_look: True if something has happened that may have ended a wait.
        make_plain_steps: function that makes the steps up to the end of the next wait, if it can do so in any thread;
            it returns False if it has made none. None while no steps may be made.
        visited: programs that may have ended, or whose threads may wait for each other, since their last turn; whoever
            looks after them empties it.
    """

    def __init__(self, now_ns: Callable[[], int]) -> None:
        self.now_ns = now_ns
        self._tasks: list[Task] = []
        self._returned = TurnSignal()
        self._created = self.hand_overs = 0
        self.needs_look = False
        self.visited: set[NodeProgram] = set()
        self._inside: NodeProgram | None = None
        self.make_plain_steps: Callable[[], bool] | None = None
        self._turn: tuple[Task, float] | None = None  # task that has the turn, and the wall time of its begin [s]
        self._round: Iterator[Task] = iter(())
        self._has_changed = self._passes_on = self._is_away = self._was_interrupted = False
        self._caller: Task | None = None  # task whose request the thread that steps the simulation shall call
        self._error: BaseException | None = None

    @property
    def next_ns(self) -> int | None:
        """Next simulated time [ns] for which a task waits; None if no task waits for a time."""
        times = [task.until_ns for task in self._tasks if task.until_ns is not None]
        return min(times) if times else None

    def create(self, program: NodeProgram, function: Callable[[], object], name: str) -> Task:
        """Create a task, which gets its first turn after those of older tasks."""
        self._created += 1
        task = Task(self, program, function, name, self._created)
        task.until_ns = self.now_ns()
        self._tasks.append(task)
        self.needs_look = True
        return task

    def tasks_of(self, program: NodeProgram) -> list[Task]:
        """Return the tasks of a program that have not ended, in the order of their creation."""
        return [task for task in self._tasks if task.program is program]

    def count_turns_anew(self) -> None:
        """Count the turns at the present time from 0: a new call of a script or a tool is no endless exchange."""
        for task in self._tasks:
            task.turns = (-1, 0)

    def run_ready(self) -> None:
        """Give turns to tasks whose wait has ended, until all tasks wait."""
        self._round, self._has_changed = iter(()), True
        while (task := self._next_due()) is not None:
            self._give_turn(task, passes_on=True)

    def _next_due(self) -> Task | None:
        """Return the next task whose wait has ended, in the order of creation; None if all tasks wait."""
        now = self.now_ns()
        while True:
            for task in self._round:
                if not task.is_done and self._is_due(task, now):
                    self._has_changed = True
                    return task
            if not (self._has_changed or self.needs_look):
                return None
            self._has_changed = self.needs_look = False
            self._round = iter(tuple(self._tasks))

    def _is_due(self, task: Task, now: int) -> bool:
        if not (task.until_ns is not None and now >= task.until_ns) and not (task.is_ready and task.is_ready()):
            return False
        time_ns, count = task.turns
        task.turns = now, count + 1 if time_ns == now else 1
        if task.turns[1] > MAX_TURNS:
            task.until_ns = now + 1  # a step later; two programs may otherwise answer each other for ever
            return False
        return True

    def _give_turn(self, task: Task, *, passes_on: bool) -> None:
        """Let a task run until it waits or ends, and call what tasks request meanwhile.

        Args:
            task: task.
            passes_on: True if the task then gives the turn to the next one; the turn comes back after the last one.
        """
        self._passes_on = passes_on
        self._let_run(task)
        while self._caller is not None:
            caller, self._caller = self._caller, None
            self.leave_program()
            caller.answer_request()
            self._let_run(caller)

    def _let_run(self, task: Task) -> None:
        """Give a task the turn, and wait until the turn comes back."""
        longest = inf if self._passes_on else _GRACE
        shortest = min(longest, *[task.program.options.limit for task in self._tasks])
        if self._was_interrupted:
            self._was_interrupted = False
            self._returned.wait(0.0)  # an interrupt between the end of the turn and this signal
        self._prepare_turn(task)
        self._is_away = True
        self._start_turn(task)
        try:
            if not self._returned.wait(min(shortest, _SIGNAL_PERIOD)):
                self._await_return(shortest, longest)
        except BaseException:  # Ctrl-C: the task must give the turn back before anything else runs
            self._passes_on, self._was_interrupted = False, True
            if self._turn is not None:
                self.visited.add(self._turn[0].program)
            if not self._returned.wait(_GRACE if self._is_away else 0.0) and self._turn is not None:
                self._stop(self._turn[0])
            if self._caller is not None:
                self._caller.request, self._caller = None, None
            raise
        if self._error is not None:
            error, self._error = self._error, None
            raise error

    def _prepare_turn(self, task: Task) -> None:
        """Let the process have the values of a task's program."""
        self.hand_overs += 1
        program = task.program
        program.hand_overs += 1
        if program is not self._inside:
            self.leave_program()
            self._inside = program
            program.process.enter()
        task.polls = 0
        self._turn = task, monotonic()

    def _start_turn(self, task: Task) -> None:
        if not task.is_started:
            task.begin()
        task.turn.set()

    def _await_return(self, shortest: float, longest: float) -> None:
        """Wait until all tasks wait; stop a task that runs for longer than its program may.

        Args:
            shortest: shortest time that a program may run [s].
            longest: longest time that a program may run, whatever its own limit is [s].
        """
        while not self._returned.wait(min(shortest / 10, _SIGNAL_PERIOD)):
            turn = self._turn
            if turn is None:
                continue
            task, begun = turn
            limit = min(longest, task.program.options.limit)
            if monotonic() >= begun + limit:  # else other tasks had the turn before
                self._passes_on = False
                task.program.meet_stuck(task, limit)
                self._stop(task)
                return

    def leave_program(self) -> None:
        """Give the process its own values back, instead of those of the program that ran last."""
        program, self._inside = self._inside, None
        if program is not None:
            program.process.leave()

    def take_back(self, task: Task) -> bool:
        """Receive the turn from a task, and give it to the next one; return True if that is the same task.

        The task itself calls this, in its thread.
        """
        if task.is_abandoned:
            return False
        self._note_return(task)
        if task.request is not None:
            self._caller = task
        following = self._choose_following() if self._passes_on and task.request is None else None
        if following is None:
            self._turn = None
            self._is_away = False
            self._returned.set()
        elif following is not task:
            self._start_turn(following)
        return following is task

    def _note_return(self, task: Task) -> None:
        if task.is_done:
            self._tasks.remove(task)
        if task.is_done or task.waits_for is not None or task.program.is_exiting:
            self.visited.add(task.program)

    def _choose_following(self) -> Task | None:
        """Return the task that gets the turn next, with the values of its program in the process; None if all wait."""
        ident = _thread.get_ident()
        task = TASKS.pop(ident, None)  # the conditions of other tasks are no questions of this task
        try:
            following = self._next_due()
            while following is None and self._passes_on and self.make_plain_steps is not None:
                self._turn = None
                if not self.make_plain_steps():
                    break
                self._has_changed = True
                following = self._next_due()
            if following is not None:
                self._prepare_turn(following)
        except BaseException as error:  # noqa: BLE001 - the thread that steps the simulation raises it
            self._error = error
            return None
        else:
            return following
        finally:
            if task is not None:
                TASKS[ident] = task

    def _stop(self, task: Task) -> None:
        """Raise an exception in a task that computes for too long; abandon it if it does not give the turn back."""
        task.is_ending = True
        begun = monotonic()
        while monotonic() < begun + _GRACE:
            task.raise_in_thread(ProgramStuck)
            if self._returned.wait(_GRACE / 10):
                return
        task.is_abandoned = task.is_done = True
        self._turn = None
        self._note_return(task)

    def end(self, program: NodeProgram) -> None:
        """End all tasks of a program: each gets an exception where it waits, and its `finally` blocks run.

        Simulated time stands still meanwhile, so a wait for a time ends at once. A task that does not end although it
        was asked `MAX_ENDINGS` times is abandoned, and this is reported.
        """
        for _ in range(MAX_ENDINGS):
            for task in self.tasks_of(program):
                if not task.is_done:
                    task.is_ending = task.is_asked_to_end = True
                    self._give_turn(task, passes_on=False)
                    self._run_ending(program)
            if not self.tasks_of(program):
                return
        for task in self.tasks_of(program):
            program.tell("SK-NODE-059", task.frame)
            task.is_abandoned = task.is_done = True
            self._tasks.remove(task)

    def _run_ending(self, program: NodeProgram) -> None:
        """Give turns to the tasks of a program that were asked to end and need not wait any longer."""
        has_changed = True
        while has_changed:
            has_changed = False
            for task in self.tasks_of(program):
                if task.is_done or not task.is_ending or task.ended_waits >= MAX_ENDED_WAITS:
                    continue
                if task.until_ns is not None or (task.is_ready and task.is_ready()):
                    task.ended_waits += 1
                    has_changed = True
                    self._give_turn(task, passes_on=False)

    def shift(self, duration_ns: int) -> None:
        """Move the ends of all waits for a time [ns], after simulated time has jumped."""
        for task in self._tasks:
            if task.until_ns is not None:
                task.until_ns += duration_ns


def deadlocked_tasks(tasks: Iterable[Task]) -> list[Task]:
    """Return the tasks that wait for locks of each other; an empty list if none do.

    Args:
        tasks: tasks of a program.
    """
    for task in tasks:
        chain: list[Task] = []
        current: Task | None = task
        while current is not None and current not in chain:
            chain.append(current)
            current = current.waits_for() if current.waits_for is not None else None
        if current is not None and len(chain) - chain.index(current) > 1:  # alone: a condition waits for another task
            return chain[chain.index(current) :]
    return []


def line_of(frame: FrameType | None) -> str:
    """Return `file:line` of a frame; an empty text for None."""
    return "" if frame is None else f"{frame.f_code.co_filename}:{frame.f_lineno}"
