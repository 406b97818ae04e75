"""Mesh files: reading triangles, making convex collision bodies, and caching both.

A mesh file and its companion files enter; `MeshPart`s in metres and convex bodies leave. Files may be hostile, so
sizes, depths and references are limited. MuJoCo is not used here.
"""
