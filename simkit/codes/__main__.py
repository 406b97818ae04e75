"""`python -m simkit.codes > docs/diagnostics.md` writes the page."""

from __future__ import annotations

import sys

from simkit.codes.page import page

sys.stdout.write(page())
