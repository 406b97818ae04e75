"""Tasks that report the health of a node, for the packages `diagnostic_updater` of ROS 1 and ROS 2.

A task fills in a status: a `diagnostic_msgs/msg/DiagnosticStatus` of either ROS with the functions of
`StatusFunctions`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from simkit_nodes.host import current_host

__all__ = [
    "CompositeDiagnosticTask",
    "DiagnosticTask",
    "DiagnosticTaskVector",
    "FrequencyStatus",
    "FrequencyStatusParam",
    "FunctionDiagnosticTask",
    "HeaderlessTopicDiagnostic",
    "Heartbeat",
    "TimeStampStatus",
    "TimeStampStatusParam",
    "TopicDiagnostic",
]


class StatusFunctions:
    """Functions of a status; a base of the classes `DiagnosticStatusWrapper`."""

    level: Any
    message: str

    def summary(self: Any, *args: Any) -> None:
        """Set the level and the message, from another status, or from a level and a text."""
        level, message = (args[0].level, args[0].message) if len(args) == 1 else args
        self.level, self.message = level, str(message)

    def clearSummary(self: Any) -> None:
        """Set the level OK without a message."""
        self.summary(self.OK, "")

    def mergeSummary(self: Any, *args: Any) -> None:
        """Take the worse level, and join messages if both levels are OK or none is; see `summary`."""
        level, message = (args[0].level, args[0].message) if len(args) == 1 else args
        if (level > self.OK) == (self.level > self.OK):
            self.message = f"{self.message}; {message}" if self.message else message
        elif level > self.level:
            self.message = message
        self.level = max(level, self.level)

    def add(self: Any, key: str, val: Any) -> None:
        """Add a value with a name."""
        self.values.append(self._key_value(key=key, value=str(val) if self._converts_values else val))


class DiagnosticTask:
    """Task with a name.

    Args:
        name: name.
    """

    def __init__(self, name: str) -> None:
        self.name = name

    def getName(self) -> str:
        """Return the name."""
        return self.name

    def run(self, stat: Any) -> Any:
        """Fill in a status and return it."""
        return stat


class FunctionDiagnosticTask(DiagnosticTask):
    """Task that calls a function.

    Args:
        name: name.
        fn: function that fills in a status and returns it.
    """

    def __init__(self, name: str, fn: Callable[[Any], object]) -> None:
        super().__init__(name)
        self.fn = fn

    def run(self, stat: Any) -> Any:
        """Call the function."""
        return self.fn(stat)


class CompositeDiagnosticTask(DiagnosticTask):
    """Task of several tasks that gives one status: the worst level, and the messages that are not OK."""

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.tasks: list[DiagnosticTask] = []

    def addTask(self, t: DiagnosticTask) -> None:
        """Add a task."""
        self.tasks.append(t)

    def run(self, stat: Any) -> Any:
        """Run all tasks."""
        combined, original = type(stat)(), type(stat)()
        original.summary(stat)
        for task in self.tasks:
            stat.summary(original)
            stat = task.run(stat)
            combined.mergeSummary(stat)
        stat.summary(combined)
        return stat


class DiagnosticTaskVector:
    """Tasks of an updater, with `name` and `fn`."""

    def __init__(self) -> None:
        self.tasks: list[FunctionDiagnosticTask] = []

    def addedTaskCallback(self, task: FunctionDiagnosticTask) -> None:
        """Report a new task."""

    def add(self, *args: Any) -> None:
        """Add a task, or a name and a function that fills in a status and returns it."""
        task = args[0]
        self.tasks.append(FunctionDiagnosticTask(*((task.getName(), task.run) if len(args) == 1 else args)))
        self.addedTaskCallback(self.tasks[-1])

    def removeByName(self, name: str) -> bool:
        """Remove the first task with a name; return False if there is none."""
        task = next((task for task in self.tasks if task.name == name), None)
        if task is not None:
            self.tasks.remove(task)
        return task is not None

    def statuses(self, status_class: type[Any], hardware_id: str) -> list[Any]:
        """Run all tasks and return their statuses."""
        statuses = []
        for task in list(self.tasks):
            status: Any = status_class()
            status.level, status.name, status.message = status.ERROR, task.name, "No message was set"
            status.hardware_id = hardware_id
            statuses.append(task.run(status))
        return statuses

    def equal_statuses(self, status_class: type[Any], level: Any, message: str) -> list[Any]:
        """Return a status of all tasks with the same level and message."""
        statuses = []
        for task in self.tasks:
            status: Any = status_class(name=task.name)
            status.summary(level, message)
            statuses.append(status)
        return statuses


class FrequencyStatusParam:
    """Limits of a rate.

    Args:
        freq_bound: dictionary with the lowest rate `min` and, if there is one, the highest rate `max` [Hz].
        tolerance: part of a limit by which the rate may be beyond it.
        window_size: number of updates over which the rate is calculated.
    """

    def __init__(self, freq_bound: dict[str, float], tolerance: float = 0.1, window_size: int = 5) -> None:
        self.freq_bound, self.tolerance, self.window_size = freq_bound, tolerance, window_size


class FrequencyStatus(DiagnosticTask):
    """Task that checks the rate of events.

    Args:
        params: limits.
        name: name.
    """

    def __init__(self, params: FrequencyStatusParam, name: str = "FrequencyStatus") -> None:
        super().__init__(name)
        self.params = params
        self.clear()

    def clear(self) -> None:
        """Start anew."""
        self.count = 0
        self._updates = [(current_host().now_ns(), 0)] * self.params.window_size

    def tick(self) -> None:
        """Count an event."""
        self.count += 1

    def run(self, stat: Any) -> Any:
        """Compare the rate with its limits."""
        now = current_host().now_ns()
        since_ns, count = self._updates.pop(0)
        self._updates.append((now, self.count))
        events, window = self.count - count, (now - since_ns) * 1e-9
        rate = events / window if window else 0.0
        low, high = self.params.freq_bound["min"], self.params.freq_bound.get("max")
        lowest = low * (1 - self.params.tolerance)
        highest = None if high is None else high * (1 + self.params.tolerance)
        if events == 0:
            stat.summary(stat.ERROR, "No events recorded.")
        elif rate < lowest:
            stat.summary(stat.WARN, "Frequency too low.")
        elif highest is not None and rate > highest:
            stat.summary(stat.WARN, "Frequency too high.")
        else:
            stat.summary(stat.OK, "Desired frequency met")
        stat.add("Events in window", f"{events:d}")
        stat.add("Events since startup", f"{self.count:d}")
        stat.add("Duration of window (s)", f"{window:f}")
        stat.add("Actual frequency (Hz)", f"{rate:f}")
        if low == high:
            stat.add("Target frequency (Hz)", f"{low:f}")
        if low > 0:
            stat.add("Minimum acceptable frequency (Hz)", f"{lowest:f}")
        if highest is not None:
            stat.add("Maximum acceptable frequency (Hz)", f"{highest:f}")
        return stat


class TimeStampStatusParam:
    """Limits of the age of stamps [s]."""

    def __init__(self, min_acceptable: float = -1, max_acceptable: float = 5) -> None:
        self.min_acceptable, self.max_acceptable = min_acceptable, max_acceptable


class TimeStampStatus(DiagnosticTask):
    """Task that checks the age of stamps.

    Args:
        params: limits.
        name: name.
    """

    def __init__(self, params: TimeStampStatusParam | None = None, name: str = "Timestamp Status") -> None:
        super().__init__(name)
        self.params = params or TimeStampStatusParam()
        self.early_count = self.late_count = self.zero_count = 0
        self._ages: list[float] = []
        self._has_zero = False

    def tick(self, stamp: Any) -> None:
        """Take a stamp: a number [s], or a time of `rclpy` or `rospy`."""
        seconds = stamp
        if not isinstance(stamp, (int, float)):
            seconds = stamp.to_sec() if hasattr(stamp, "to_sec") else stamp.nanoseconds * 1e-9
        if seconds == 0:
            self._has_zero = True
        else:
            self._ages.append(current_host().now_ns() * 1e-9 - seconds)

    def run(self, stat: Any) -> Any:
        """Compare the ages since the last update with their limits."""
        stat.summary(stat.OK, "Timestamps are reasonable.")
        youngest, oldest = min(self._ages, default=0.0), max(self._ages, default=0.0)
        if not self._ages:
            stat.summary(stat.WARN, "No data since last update.")
        else:
            if youngest < self.params.min_acceptable:
                stat.summary(stat.ERROR, "Timestamps too far in future seen.")
                self.early_count += 1
            if oldest > self.params.max_acceptable:
                stat.summary(stat.ERROR, "Timestamps too far in past seen.")
                self.late_count += 1
            if self._has_zero:
                stat.summary(stat.ERROR, "Zero timestamp seen.")
                self.zero_count += 1
        stat.add("Earliest timestamp delay:", f"{youngest:f}")
        stat.add("Latest timestamp delay:", f"{oldest:f}")
        stat.add("Earliest acceptable timestamp delay:", f"{self.params.min_acceptable:f}")
        stat.add("Latest acceptable timestamp delay:", f"{self.params.max_acceptable:f}")
        stat.add("Late diagnostic update count:", f"{self.late_count}")
        stat.add("Early diagnostic update count:", f"{self.early_count}")
        stat.add("Zero seen diagnostic update count:", f"{self.zero_count}")
        self._ages.clear()
        self._has_zero = False
        return stat


class Heartbeat(DiagnosticTask):
    """Task that is always OK."""

    def __init__(self) -> None:
        super().__init__("Heartbeat")

    def run(self, stat: Any) -> Any:
        """Report that the node runs."""
        stat.summary(stat.OK, "Alive")
        return stat


class HeaderlessTopicDiagnostic(CompositeDiagnosticTask):
    """Task that checks the rate of a topic.

    Args:
        name: name of the topic.
        diag: updater that gets the task.
        freq: limits of the rate.
    """

    def __init__(self, name: str, diag: DiagnosticTaskVector, freq: FrequencyStatusParam) -> None:
        super().__init__(name + " topic status")
        self.diag, self.freq = diag, FrequencyStatus(freq)
        self.addTask(self.freq)
        diag.add(self)

    def tick(self, *_: Any) -> None:
        """Count a message."""
        self.freq.tick()

    def clear_window(self) -> None:
        """Start anew."""
        self.freq.clear()


class TopicDiagnostic(HeaderlessTopicDiagnostic):
    """Task that checks the rate of a topic and the age of its stamps.

    Args:
        name: name of the topic.
        diag: updater that gets the task.
        freq: limits of the rate.
        stamp: limits of the age.
    """

    def __init__(
        self, name: str, diag: DiagnosticTaskVector, freq: FrequencyStatusParam, stamp: TimeStampStatusParam
    ) -> None:
        super().__init__(name, diag, freq)
        self.stamp = TimeStampStatus(stamp)
        self.addTask(self.stamp)

    def tick(self, stamp: Any) -> None:
        """Count a message with its stamp."""
        self.stamp.tick(stamp)
        super().tick()
