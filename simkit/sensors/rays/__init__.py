"""Ray sensors (lidar, sonar) and the casting of rays from one point.

A `<sensor>` and the simulation enter; `LaserScan`, point clouds and `Range` messages leave. Few rays are cast by
MuJoCo, many by NumPy on shapes and by Embree on triangles, all to the same distances. Nothing here needs OpenGL.
"""
