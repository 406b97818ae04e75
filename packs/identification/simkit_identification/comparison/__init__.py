"""Comparison of two recordings, of a recording with a run, and of two sets of runs."""
