"""Availability of a renderer, for tests that need images."""

from __future__ import annotations

from typing import Final

import pytest

from simkit.errors import RenderError
from simkit.sensors.cameras.rendering import gl_context


def _why_not() -> str:
    try:
        with gl_context.current():
            return ""
    except RenderError as error:
        return str(error)


_REASON: Final = _why_not()

RENDERS: Final = not _REASON

NEEDS_RENDERER: Final = pytest.mark.skipif(not RENDERS, reason=_REASON)
