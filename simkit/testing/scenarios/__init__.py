"""Scenarios: their files in YAML or Python, and their runs.

A scenario file gives a `RunSpec`. Running a `RunSpec` gives a simulation and the results of its checks. All problems of
a file are reported at once, with file and line. `simkit.testing.run_record` records the outputs of a run.
"""
