"""What a check of golden runs found: for the terminal, as a page, as JUnit XML."""

from __future__ import annotations

from simkit.golden.report.cases import junit_cases
from simkit.golden.report.html import write_html
from simkit.golden.report.text import text_report

__all__ = ["junit_cases", "text_report", "write_html"]
