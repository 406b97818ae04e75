"""Options of `simkit run` that the pack adds."""
