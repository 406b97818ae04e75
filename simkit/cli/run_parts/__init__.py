"""Run parts of the core: options of `simkit run` with what they do, one file each."""
