"""Run parts of the pack view: options of `simkit run` with what they do."""
