"""Pack for learning: sweeps over parameters and seeds, and environments of Gymnasium.

`simkit.sweep` and `simkit.gym` are the public names.
"""
