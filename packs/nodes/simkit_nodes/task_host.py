"""World around programs whose threads are tasks."""

from __future__ import annotations

from collections.abc import Callable

from simkit_nodes.tasks import Task, TaskScheduler, current_task


class TaskHost:
    """World around programs whose threads are tasks: it starts them and has them wait.

    Attributes:
        tasks: scheduler of the threads.
    """

    tasks: TaskScheduler

    def wait(self, until_ns: int | None = None, is_ready: Callable[[], bool] | None = None) -> None:
        """Wait until a time [ns] or until a condition holds."""
        task = current_task()
        if task is None:
            raise RuntimeError("only a thread of a program can wait")
        task.wait(until_ns, is_ready)

    def poll(self) -> None:
        """Count a question that does not wait."""
        task = current_task()
        if task is not None:
            task.poll()

    def start_thread(self, function: Callable[[], object], name: str) -> Task:
        """Start a thread of the present program."""
        task = current_task()
        if task is None:
            raise RuntimeError("only a program can start a thread")
        return self.tasks.create(task.program, function, name)
