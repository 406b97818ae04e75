"""Comparison of simkit's reading of a robot with that of another program, for `simkit check --against`.

`robot_reading` has the content of a URDF file as plain numbers, `yourdfpy_reader` the same as yourdfpy reads it.
`reading_differences` compares both, and `against_option` reports the differences with their lines.
"""
