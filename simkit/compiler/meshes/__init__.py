"""Mesh files: reading triangles, making convex collision bodies, and caching both.

The input is a mesh file with its companion files; the output is `MeshPart`s in metres and convex bodies. Files may be
hostile, so sizes, nesting depths and references are limited. This package does not use MuJoCo.
"""
