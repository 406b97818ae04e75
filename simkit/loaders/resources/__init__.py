"""Input files: where they are, and how they are read.

A URI, a ROS package or a bundled name enters; a path, or a file's content as `Params`, leaves. Everything is read
within bounds and inside the resource folders; nothing is fetched from a network, and no format is interpreted here.
"""
