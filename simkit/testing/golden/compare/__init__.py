"""Comparison of two run records: topics, numbers, pictures, noise, physics and inputs.

The inputs are two `RunRecord` objects. The result is a `Comparison` with the first difference of each field and its
tolerance, in words. This package runs no simulation and does not search for causes.
"""
