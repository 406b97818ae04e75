"""Availability of OpenGL, for tests of OpenGL itself. All other tests draw in software where it is missing."""

from __future__ import annotations

from typing import Final

import pytest

from simkit.errors import RenderError
from simkit.sensors.cameras.rendering import gl_context


def _why_not() -> str:
    try:
        gl_context.ensure_open()
    except RenderError as error:
        return str(error)
    return ""


_REASON: Final = _why_not()

NEEDS_GL: Final = pytest.mark.skipif(bool(_REASON), reason=_REASON)
