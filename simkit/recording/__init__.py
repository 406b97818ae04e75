"""Recording and playback of runs: bags, charts, pictures, exported tables and scripted commands.

Files are written completely or not at all. Recording never changes the measurements. This package does not depend on
sensor types, plugins or simkit's commands. The modules are imported on first use.
"""
