"""Convex collision bodies of meshes: hulls, pieces, height fields and boxes, with a cache of the results.

The input is the triangles of `MeshPart`s, from files that may be hostile. This package does not use MuJoCo.
"""
