"""Options of `simkit run` of the pack verification."""
