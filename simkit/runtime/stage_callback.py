"""Calls into Python between the velocities and the forces of a forward pass that the engine makes by itself.

The engine has one such place, `mjcb_control`, for the whole process. It is taken for the length of one call only, and
what was there before is called as well.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import mujoco


@contextmanager
def called_before_forces(data: Any, call: Callable[[], None]) -> Iterator[None]:
    """Have a function called in every forward pass of some data; not in those that the function itself makes.

    Args:
        data: of the engine; passes of others, on other threads, are left alone.
        call: may change the contacts and the references of constraints of these data.
    """
    before = mujoco.get_mjcb_control()
    is_busy = False

    def control(model: Any, passing: Any) -> None:
        nonlocal is_busy
        if before is not None:
            before(model, passing)
        if passing is data and not is_busy:
            is_busy = True
            try:
                call()
            finally:
                is_busy = False

    mujoco.set_mjcb_control(control)
    try:
        yield
    finally:
        mujoco.set_mjcb_control(before)
