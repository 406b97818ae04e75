"""Whole runs: describe them, check them, record them, compare them and repeat them.

A run specification (`simkit.run_spec.RunSpec`) or a running simulation enters; results of checks, records, reference
runs, certificates, grades and bundles leave. Nothing here changes how a simulation behaves: whoever watches a run
changes none of its bits. The command line calls this room; no other room imports it.
"""
