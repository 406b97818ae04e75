"""Many runs of a world: sweeps over parameters and seeds, and environments for learning.

`simkit.sweep` and `simkit.gym` are the public names.
"""
