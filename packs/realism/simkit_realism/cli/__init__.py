"""Options of the pack for `simkit run`."""
