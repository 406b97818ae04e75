"""Thread that waits for messages and requests from ROS, so that the bridge's main thread only waits for files."""

from __future__ import annotations

import os
import threading
from collections.abc import Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rclpy.client import Client
    from rclpy.context import Context
    from rclpy.service import Service
    from rclpy.subscription import Subscription

_LONGEST = 10**9  # [ns], longest wait


class RosWaiter:
    """Thread that waits for data from ROS and then stops until the main thread has read the data.

    rclpy's executors create a set of all entities for each message, which takes 2.7 ms for 53 entities. This thread
    keeps its set until an entity is opened or closed, which is only allowed while the thread is stopped.

    Args:
        context: context of rclpy.

    Attributes:
        ready: pointers of the subscriptions, services and clients that have data, while the thread is stopped.
    """

    def __init__(self, context: Context) -> None:
        from rclpy.impl.implementation_singleton import rclpy_implementation

        self._implementation, self._context = rclpy_implementation, context
        with context.handle:
            self._guard = rclpy_implementation.GuardCondition(context.handle)
        self._subscriptions: Sequence[object] = ()
        self._services: Sequence[object] = ()
        self._clients: Sequence[object] = ()
        self._is_changed = True
        self.ready: frozenset[int] = frozenset()
        self._read, self._write = os.pipe()
        os.set_blocking(self._read, False)
        self._resume = threading.Semaphore(0)
        self._is_stopped, self._is_over = True, False
        self._thread = threading.Thread(target=self._run, name="simkit waits for ROS", daemon=True)
        self._thread.start()

    def fileno(self) -> int:
        """Return a file descriptor for `select`; it is readable when the thread has stopped."""
        return self._read

    def is_stopped(self) -> bool:
        """Check whether the thread is stopped because data have arrived."""
        if not self._is_stopped:
            with suppress(BlockingIOError):
                self._is_stopped = bool(os.read(self._read, 1))
        return self._is_stopped

    def stop(self) -> None:
        """Stop the thread; afterwards, entities may be opened and closed."""
        if not self._is_stopped:
            self._guard.trigger_guard_condition()
            os.set_blocking(self._read, True)
            self._is_stopped = bool(os.read(self._read, 1))
            os.set_blocking(self._read, False)

    def watch(
        self, subscriptions: Sequence[Subscription], services: Sequence[Service], clients: Sequence[Client]
    ) -> None:
        """Set the subscriptions, services and clients of rclpy to wait for; the thread must be stopped."""
        self._subscriptions, self._services = [s.handle for s in subscriptions], [s.handle for s in services]
        self._clients = [c.handle for c in clients]
        self._is_changed = True

    def resume(self) -> None:
        """Continue waiting."""
        if self._is_stopped:
            self._is_stopped = False
            self._resume.release()

    def close(self) -> None:
        """End the thread."""
        self._is_over = True
        self.stop()
        self._resume.release()
        self._thread.join()

    def _run(self) -> None:
        entities: Any = None
        while True:
            self._resume.acquire()
            if self._is_over:
                break
            if self._is_changed:
                self._is_changed = False
                counts = len(self._subscriptions), 1, 0, len(self._clients), len(self._services), 0
                with self._context.handle:
                    entities = self._implementation.WaitSet(*counts, self._context.handle)
            entities.clear_entities()
            for subscription in self._subscriptions:
                entities.add_subscription(subscription)
            for service in self._services:
                entities.add_service(service)
            for client in self._clients:
                entities.add_client(client)
            entities.add_guard_condition(self._guard)
            entities.wait(_LONGEST)
            kinds = ("subscription", "service", "client")
            self.ready = frozenset(pointer for kind in kinds for pointer in entities.get_ready_entities(kind))
            os.write(self._write, b"1")
