"""Records of runs: messages, physics states and inputs of one run as arrays.

The input is a run specification or a loaded simulation. The result is a `RunRecord`. `simkit.testing.golden` compares
two records.
"""
