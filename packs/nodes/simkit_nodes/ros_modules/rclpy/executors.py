"""Executors: they call the callbacks of nodes.

As in rclpy, an executor looks which callbacks are ready, and calls them in this order: waitables of all nodes, and then
for each node timers, subscriptions, guard conditions, clients and services. Then it looks again. `spin_once` calls one
callback, so several calls are needed for all that are ready at one time.
"""

from __future__ import annotations

import inspect
import threading
import warnings
from collections import deque
from collections.abc import Callable, Generator, Iterable
from typing import TYPE_CHECKING, Any, Final

from simkit_nodes.host import current_host
from simkit_nodes.ros_modules.rclpy.task import Future, Task
from simkit_nodes.ros_modules.rclpy.utilities import get_default_context, timeout_sec_to_nsec

if TYPE_CHECKING:
    from simkit_nodes.ros_modules.rclpy.context import Context
    from simkit_nodes.ros_modules.rclpy.node import Node
    from simkit_nodes.ros_modules.rclpy.waitable import ExecutorEntity

__all__ = [
    "ConditionReachedException",
    "Executor",
    "ExternalShutdownException",
    "MultiThreadedExecutor",
    "ShutdownException",
    "SingleThreadedExecutor",
    "TimeoutException",
    "TimeoutObject",
    "await_or_execute",
]

DEFAULT_THREADS: Final = 8
"""Number of threads of a `MultiThreadedExecutor`; rclpy takes the number of processors, which differs by computer."""

Work = tuple[Task, "ExecutorEntity | None", "Node | None"]


async def await_or_execute(callback: Callable[..., object], *args: object) -> Any:
    """Call a function, or await a coroutine function."""
    if inspect.iscoroutinefunction(callback):
        return await callback(*args)
    return callback(*args)


class TimeoutException(Exception):
    """Nothing was ready within the timeout."""


class ShutdownException(Exception):
    """The executor was shut down."""


class ExternalShutdownException(Exception):
    """The context was shut down."""


class ConditionReachedException(Exception):
    """The future is done."""


class TimeoutObject:
    """Timeout that can be changed [s]."""

    def __init__(self, timeout: float) -> None:
        self.timeout = timeout


def _never() -> bool:
    return False


class Executor:
    """Base of the executors.

    Args:
        context: context whose end ends the executor; None for the default one.
    """

    def __init__(self, *, context: Context | None = None) -> None:
        self._context = get_default_context() if context is None else context
        self._host = current_host()
        self._nodes: dict[Node, None] = {}
        self._tasks: list[Work] = []
        self._lock = threading.Lock()  # threads of a program in its own process run at the same time
        self._is_shutdown = False
        self._running = 0
        self._wakes = self._waiting = 0
        self._idle_ns = -1
        self._work: Generator[Work, None, None] | None = None
        self._work_arguments: tuple[Any, ...] = ()
        self._context.on_shutdown(self.wake)

    @property
    def context(self) -> Context:
        """Context whose end ends the executor."""
        return self._context

    def create_task(self, callback: Callable[..., object], *args: object, **kwargs: object) -> Task:
        """Have a function or coroutine function called by the executor; return a future for its result."""
        task = Task(callback, args, kwargs, executor=self)
        with self._lock:
            self._tasks.append((task, None, None))
        self.wake()
        return task

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        """Call no more callbacks; those that run end later, as in rclpy. Return True.

        Args:
            timeout_sec: has no effect.
        """
        self._is_shutdown = True
        self.wake()
        self._nodes.clear()
        self._work = None
        return True

    def add_node(self, node: Node) -> bool:
        """Add a node; return False if it was added before."""
        if node in self._nodes:
            return False
        self._nodes[node] = None
        node.executor = self
        self.wake()
        return True

    def remove_node(self, node: Node) -> None:
        """Remove a node, if it was added."""
        if node in self._nodes:
            del self._nodes[node]
            self.wake()

    def get_nodes(self) -> list[Node]:
        """Return the nodes in the order in which they were added."""
        return list(self._nodes)

    def wake(self) -> None:
        """Have the executor look again what is ready."""
        self._wakes += 1
        if self._waiting:
            self._host.wake()

    # ------------------------------------------------------------------ spinning

    def spin(self) -> None:
        """Call callbacks until the context or the executor is shut down.

        Raises:
            ExternalShutdownException: the simulation has ended.
        """
        while self._context.is_valid and not self._is_shutdown:
            self.spin_once()
        if self._context.is_ended_from_outside:
            raise ExternalShutdownException

    def _end_wait_with(self, future: Any) -> None:
        """Have a future end the wait of this executor; it may be one of `asyncio` or `concurrent.futures`."""
        if isinstance(future, Future):
            future._wake_when_done(self)
        else:
            future.add_done_callback(lambda _: self.wake())

    def spin_until_future_complete(self, future: Future, timeout_sec: float | None = None) -> None:
        """Call callbacks until a future is done, or for a time [s]; None for no limit."""
        self._end_wait_with(future)
        if timeout_sec is None or timeout_sec < 0:
            while self._context.is_valid and not future.done() and not self._is_shutdown:
                self.spin_once_until_future_complete(future, timeout_sec)
            return
        end_ns = self._host.now_ns() + timeout_sec_to_nsec(timeout_sec)
        left = TimeoutObject(timeout_sec)
        while self._context.is_valid and not future.done() and not self._is_shutdown:
            self.spin_once_until_future_complete(future, left)
            now = self._host.now_ns()
            if now >= end_ns:
                return
            left.timeout = (end_ns - now) / 1e9

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Wait for a callback and call it.

        Args:
            timeout_sec: longest wait [s]; None for no limit, 0 for no wait.

        Raises:
            ExternalShutdownException: the context was shut down.
        """
        self._spin_once(timeout_sec, _never)

    def spin_once_until_future_complete(self, future: Future, timeout_sec: float | TimeoutObject | None = None) -> None:
        """Wait for a callback and call it, unless a future is done before; see `spin_once`."""
        self._end_wait_with(future)
        self._spin_once(timeout_sec, future.done)

    def _spin_once(self, timeout_sec: float | TimeoutObject | None, condition: Callable[[], bool]) -> None:
        raise NotImplementedError

    def can_execute(self, entity: ExecutorEntity) -> bool:
        """Check whether the callback of a subscription, timer and so on may begin."""
        return not entity._executor_event and entity.callback_group.can_execute(entity)

    def wait_for_ready_callbacks(
        self,
        timeout_sec: float | TimeoutObject | None = None,
        nodes: list[Node] | None = None,
        condition: Callable[[], bool] = _never,
    ) -> Work:
        """Return the next callback that is ready, with its entity and its node.

        Args:
            timeout_sec: longest wait [s]; None for no limit, 0 for no wait.
            nodes: nodes; None for all.
            condition: function that returns True to end the wait.

        Raises:
            TimeoutException, ShutdownException, ExternalShutdownException, ConditionReachedException: nothing is ready.
        """
        arguments = (timeout_sec, nodes, condition)
        while True:
            if self._work is None or self._work_arguments != arguments:
                self._work_arguments = arguments
                self._work = self._ready_work(timeout_sec, nodes, condition)
            try:
                return next(self._work)
            except StopIteration:
                self._work = None

    def _ready_work(
        self,
        timeout_sec: float | TimeoutObject | None,
        nodes: list[Node] | None,
        condition: Callable[[], bool],
    ) -> Generator[Work, None, None]:
        """Yield what is ready at one time: first the tasks that were begun, then the callbacks."""
        timeout_ns = timeout_sec_to_nsec(timeout_sec.timeout if isinstance(timeout_sec, TimeoutObject) else timeout_sec)
        end_ns = None if timeout_ns < 0 else self._host.now_ns() + timeout_ns
        has_yielded = False
        while not has_yielded and not self._is_shutdown and not condition():
            for work in tuple(reversed(self._tasks)):
                if not work[0].executing() and work[0]._pending():
                    has_yielded = True
                    yield work
            with self._lock:
                self._tasks = [work for work in self._tasks if work[0]._pending()]
            seen = self._wakes
            ready = self._ready_entities(nodes)
            if not ready:
                if timeout_ns == 0:
                    self._rest(seen)
                else:
                    self._wait(end_ns, nodes, seen)
                ready = self._ready_entities(nodes)
                if not ready and timeout_ns == 0:
                    self._idle_ns = self._host.now_ns()
            if self._is_shutdown:
                raise ShutdownException
            if not self._context.is_valid:
                raise ExternalShutdownException
            is_late = end_ns is not None and self._host.now_ns() >= end_ns
            for node, entity in ready:
                if entity.callback_group.can_execute(entity) and entity._is_ready():
                    has_yielded = True
                    yield self._make_handler(entity, node)
            if is_late:
                raise TimeoutException
        if self._is_shutdown:
            raise ShutdownException
        if condition():
            raise ConditionReachedException

    def _ready_entities(self, nodes: list[Node] | None) -> list[tuple[Node, ExecutorEntity]]:
        """Return what is ready, in the order of the calls."""
        chosen = self.get_nodes() if nodes is None else nodes
        entities: list[tuple[Node, Iterable[ExecutorEntity]]] = [(node, node._waitables) for node in chosen]
        entities += [(node, node._callback_entities()) for node in chosen]
        return [
            (node, entity)
            for node, group in entities
            for entity in group
            if entity._is_ready() and self.can_execute(entity)
        ]

    def _wait(self, end_ns: int | None, nodes: list[Node] | None, seen: int) -> None:
        """Wait for a time of the host [ns], for a timer, or for `wake`."""
        times = [] if end_ns is None else [end_ns]
        for node in self.get_nodes() if nodes is None else nodes:
            for timer in node._timers:
                due_ns = timer._due_ns if self.can_execute(timer) else None
                if due_ns is not None:
                    times.append(due_ns)
        self._sleep(min(times) if times else None, seen)

    def _rest(self, seen: int) -> None:
        """Wait for a step if the executor has nothing to do a second time at the same time."""
        now = self._host.now_ns()
        if now == self._idle_ns:
            self._sleep(now + 1, seen)
        else:
            self._host.poll()

    def _sleep(self, until_ns: int | None, seen: int) -> None:
        graph = self._host.graph
        jumps = graph.jumps

        def is_over() -> bool:
            return self._wakes != seen or graph.jumps != jumps or not self._context.is_valid

        self._waiting += 1
        try:
            self._host.wait(until_ns, is_over)
        finally:
            self._waiting -= 1

    def _make_handler(self, entity: ExecutorEntity, node: Node) -> Work:
        entity._executor_event = True
        work = (Task(self._handle(entity), executor=self), entity, node)
        with self._lock:
            self._tasks.append(work)
        return work

    async def _handle(self, entity: ExecutorEntity) -> None:
        """Take the data of an entity and call its callback."""
        if self._is_shutdown or not entity.callback_group.beginning_execution(entity):
            entity._executor_event = False
            self.wake()
            return
        self._change_running(1)
        try:
            data = entity._take()
            entity._executor_event = False
            self.wake()
            if data is not None:
                await entity._execute(data)
        finally:
            self._change_running(-1)
            entity.callback_group.ending_execution(entity)
            self.wake()

    def _change_running(self, change: int) -> None:
        with self._lock:
            self._running += change

    def __enter__(self) -> Executor:
        return self

    def __exit__(self, *_: object) -> None:
        self.shutdown()


class SingleThreadedExecutor(Executor):
    """Executor that calls callbacks in the thread that spins."""

    def _spin_once(self, timeout_sec: float | TimeoutObject | None, condition: Callable[[], bool]) -> None:
        try:
            task, _, _ = self.wait_for_ready_callbacks(timeout_sec, None, condition)
        except (ShutdownException, TimeoutException, ConditionReachedException):
            return
        task()
        task.result()  # raises the exception of the callback


class MultiThreadedExecutor(Executor):
    """Executor that calls callbacks in several threads.

    Args:
        num_threads: number of threads; None for `DEFAULT_THREADS`.
        context: context whose end ends the executor; None for the default one.
    """

    def __init__(self, num_threads: int | None = None, *, context: Context | None = None) -> None:
        super().__init__(context=context)
        if num_threads == 1:
            text = "MultiThreadedExecutor is used with a single thread.\nUse the SingleThreadedExecutor instead."
            warnings.warn(text, stacklevel=2)
        self._limit = DEFAULT_THREADS if num_threads is None else num_threads
        self._threads = self._idle = 0
        self._queue: deque[Task] = deque()
        self._begun: list[Task] = []
        self._context.on_shutdown(self._host.wake)

    def _spin_once(self, timeout_sec: float | TimeoutObject | None, condition: Callable[[], bool]) -> None:
        try:
            task, _, _ = self.wait_for_ready_callbacks(timeout_sec, None, condition)
        except (ExternalShutdownException, ShutdownException, TimeoutException, ConditionReachedException):
            return
        self._begin(task)
        for begun in tuple(self._begun):
            if begun.done():
                self._begun.remove(begun)
                begun.result()  # raises the exception of the callback

    def _begin(self, task: Task) -> None:
        """Have a thread call a callback."""
        self._begun.append(task)
        self._queue.append(task)
        if self._idle < len(self._queue) and self._threads < self._limit:
            self._threads += 1
            self._host.start_thread(self._call_callbacks, f"executor thread {self._threads}")
        self._host.wake()

    def _has_work(self) -> bool:
        return bool(self._queue) or self._is_shutdown or not self._context.is_valid

    def _next_task(self) -> Task | None:
        with self._lock:
            return self._queue.popleft() if self._queue else None

    def _change_idle(self, change: int) -> None:
        with self._lock:
            self._idle += change

    def _call_callbacks(self) -> None:
        """Call callbacks until the shutdown; the function of a thread."""
        while True:
            while (task := self._next_task()) is not None:
                task()
            if self._is_shutdown or not self._context.is_valid:
                return
            self._change_idle(1)
            try:
                self._host.wait(None, self._has_work)
            finally:
                self._change_idle(-1)
