"""What a check of golden runs found: for the terminal, as a page, as JUnit XML."""

from __future__ import annotations

from simkit.testing.golden.report.html import write_html
from simkit.testing.golden.report.text import junit_cases, text_report

__all__ = ["junit_cases", "text_report", "write_html"]
