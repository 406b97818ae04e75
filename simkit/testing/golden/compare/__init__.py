"""Compare two records of runs: topics, numbers, pictures, noise, physics and inputs.

Two `RunRecord`s enter, a `Comparison` leaves: the first difference of each field, with its tolerance, in words. No
simulation is run here, and nothing is said of where a difference comes from.
"""
