"""Pack with the download of models and worlds from Fuel servers into the cache that Gazebo uses.

Only the command `simkit fetch` uses these modules. No other part of simkit connects to a server.
"""
