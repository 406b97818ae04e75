"""Ray sensors (lidar, sonar) and the casting of rays from one point.

Inputs are a `<sensor>` and the simulation. Outputs are `LaserScan`, point clouds and `Range` messages. MuJoCo casts few
rays; NumPy casts many rays on shapes, and Embree casts many rays on triangles. All give the same distances. Nothing
here needs OpenGL.
"""
