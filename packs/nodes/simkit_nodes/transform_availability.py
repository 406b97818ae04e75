"""Checks whether transforms are known, which `tf2_ros` of ROS 1 and of ROS 2 have in common."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from typing import Any

Availability = tuple[bool, str]
"""Result of a check: True if the transform is known, and the reason if it is not."""


class TransformAvailability:
    """Base of a buffer that waits for transforms; a buffer core has the checks that do not wait."""

    @abstractmethod
    def can_transform_core(self, target_frame: str, source_frame: str, time: object) -> Availability:
        """Check whether a transform is known now."""

    @abstractmethod
    def can_transform_full_core(
        self, target_frame: str, target_time: object, source_frame: str, source_time: object, fixed_frame: str
    ) -> Availability:
        """Check whether a transform between two times is known now."""

    @abstractmethod
    def _wait_for(self, check: Callable[[], Availability], timeout: object) -> Availability:
        """Wait until a check succeeds, at most for a time; return its last result."""

    def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: object,
        timeout: object = None,
        return_debug_tuple: bool = False,
    ) -> Any:
        """Check whether a transform is known, or becomes known within a time.

        Args:
            target_frame: frame of the result.
            source_frame: frame of the data.
            time: time; 0 for the latest one.
            timeout: longest wait; None for no wait.
            return_debug_tuple: return the reason, too.
        """
        result = self._wait_for(lambda: self.can_transform_core(target_frame, source_frame, time), timeout)
        return result if return_debug_tuple else result[0]

    def can_transform_full(
        self,
        target_frame: str,
        target_time: object,
        source_frame: str,
        source_time: object,
        fixed_frame: str,
        timeout: object = None,
        return_debug_tuple: bool = False,
    ) -> Any:
        """Check whether a transform between two times is known; see `can_transform`."""
        arguments = target_frame, target_time, source_frame, source_time, fixed_frame
        result = self._wait_for(lambda: self.can_transform_full_core(*arguments), timeout)
        return result if return_debug_tuple else result[0]
