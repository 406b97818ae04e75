"""Fixtures of the command line: a running simulation, and command lines in this process."""

from tests.cli.conftest import folder_of_tests, place, simkit_line, start, yard, yard_world

__all__ = ["folder_of_tests", "place", "simkit_line", "start", "yard", "yard_world"]
