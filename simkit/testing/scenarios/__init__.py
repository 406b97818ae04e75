"""Scenarios and exercises: their files in YAML or Python, their run from start to end, and the grades of solutions.

A scenario file enters, a `RunSpec` leaves; a `RunSpec` enters, its world and the results of its checks leave. All
problems of a file are reported at once, with file and line. What a run gave is recorded elsewhere
(`simkit.testing.run_record`).
"""
