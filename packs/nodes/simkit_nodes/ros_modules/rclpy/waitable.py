"""Objects for which an executor waits."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

if TYPE_CHECKING:
    from simkit_nodes.ros_modules.rclpy.callback_groups import CallbackGroup
    from simkit_nodes.ros_modules.rclpy.task import Future

__all__ = ["NumberOfEntities", "Waitable"]


class ExecutorEntity:
    """Base of timers, subscriptions, guard conditions, clients, services and waitables.

    An executor asks `_is_ready`, takes the data with `_take` when it begins the callback, and passes them to
    `_execute`.

    Attributes:
        callback_group: callback group.
    """

    callback_group: CallbackGroup
    _executor_event = False  # True from the time when an executor has chosen the callback until it begins

    def _is_ready(self) -> bool:
        """Check whether the callback can be called."""
        raise NotImplementedError

    def _take(self) -> Any:
        """Return the data for `_execute`; None if there is nothing to do any more."""
        raise NotImplementedError

    async def _execute(self, data: object) -> None:
        """Call the callback."""
        raise NotImplementedError


class NumberOfEntities:
    """Number of subscriptions, timers and so on that a waitable consists of."""

    __slots__ = (
        "num_clients",
        "num_events",
        "num_guard_conditions",
        "num_services",
        "num_subscriptions",
        "num_timers",
    )
    _names: ClassVar = ("subscriptions", "guard_conditions", "timers", "clients", "services", "events")

    def __init__(
        self,
        num_subs: int = 0,
        num_gcs: int = 0,
        num_timers: int = 0,
        num_clients: int = 0,
        num_services: int = 0,
        num_events: int = 0,
    ) -> None:
        self.num_subscriptions, self.num_guard_conditions, self.num_timers = num_subs, num_gcs, num_timers
        self.num_clients, self.num_services, self.num_events = num_clients, num_services, num_events

    def _numbers(self) -> list[int]:
        return [getattr(self, f"num_{name}") for name in self._names]

    def __add__(self, other: NumberOfEntities) -> NumberOfEntities:
        return NumberOfEntities(*(a + b for a, b in zip(self._numbers(), other._numbers(), strict=True)))

    def __repr__(self) -> str:
        return f"<{type(self).__name__}({', '.join(map(str, self._numbers()))})>"


class Waitable(ExecutorEntity):
    """Anything with callbacks of its own, such as an action server; see `Node.add_waitable`.

    Args:
        callback_group: callback group.
    """

    def __init__(self, callback_group: CallbackGroup) -> None:
        self.callback_group = callback_group
        self.callback_group.add_entity(self)
        self._futures: list[Future] = []

    def __enter__(self) -> Waitable:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def add_future(self, future: Future) -> None:
        """Add a future whose callbacks the executor calls."""
        self._futures.append(future)

    def remove_future(self, future: Future) -> None:
        """Remove a future."""
        self._futures.remove(future)

    def is_ready(self, wait_set: object) -> bool:
        """Check whether there is something to do; the argument is None."""
        raise NotImplementedError("Must be implemented by subclass")

    def take_data(self) -> Any:
        """Return the data for `execute`."""
        raise NotImplementedError("Must be implemented by subclass")

    async def execute(self, taken_data: Any) -> None:
        """Do the work."""
        raise NotImplementedError("Must be implemented by subclass")

    def get_num_entities(self) -> NumberOfEntities:
        """Return the number of subscriptions and so on."""
        return NumberOfEntities()

    def add_to_wait_set(self, wait_set: object) -> None:
        """Do nothing: executors ask `is_ready`."""

    def _is_ready(self) -> bool:
        return self.is_ready(None)

    def _take(self) -> Any:
        return (self.take_data(),)

    async def _execute(self, data: Any) -> None:
        await self.execute(data[0])
