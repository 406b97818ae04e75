"""Report verdicts of golden runs: as text for a terminal, as one HTML page, and as cases of JUnit XML.

Verdicts enter, text and files leave. The page loads nothing and runs nothing; whatever a run said stays text in it.
"""

from __future__ import annotations

from simkit.testing.golden.report.html import write_html
from simkit.testing.golden.report.text import junit_cases, text_report

__all__ = ["junit_cases", "text_report", "write_html"]
