"""Descriptions of robots that a launch file hands on as texts."""

from __future__ import annotations

from simkit import Params
from simkit.extend import Diagnostics
from simkit.loaders.resources.xml_reader import parse_text


class DescriptionError(ValueError):
    """Description that is not one of a robot; the text says why."""


def description_root(description: str) -> Params:
    """Return the root element of a description in XML.

    Raises:
        DescriptionError: the text is not XML.
    """
    problems = Diagnostics()
    root = parse_text(description, problems)
    if root is None:
        reason = next((each.message for each in problems if each.severity == "error"), "it cannot be read")
        raise DescriptionError(f"the robot description is not valid XML: {reason}")
    return root
