"""Shared code of the pack's commands: names that they look up, values on their command lines, completion."""
