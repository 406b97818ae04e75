"""Reports on golden runs: text for a terminal, one HTML page, and JUnit XML test cases.

The input is a list of verdicts. The HTML page loads no other files and runs no code, and all texts in it are escaped.
"""

from __future__ import annotations

from simkit.testing.golden.report.html import write_html
from simkit.testing.golden.report.text_report import junit_cases, text_report

__all__ = ["junit_cases", "text_report", "write_html"]
