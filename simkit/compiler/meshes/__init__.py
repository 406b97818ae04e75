"""Mesh files: read into triangles, made into convex bodies that collide, and kept in a cache.

A mesh file and its companions enter; `MeshPart`s in metres and convex bodies leave. Files come from anywhere, so
sizes, depths and references are bounded. MuJoCo is not used here.
"""
