"""Download of models and worlds from Fuel servers into the cache that Gazebo uses.

Only the command `simkit fetch` uses this package. No other part of simkit connects to a server.
"""
