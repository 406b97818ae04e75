"""Bags: MCAP files and rosbag2 folders.

`recorder` and `writer` write bags; `reader`, `playback`, `recovery` and `summary` read them. Times are simulated times.
Two runs with the same seed write the same bytes.
"""
