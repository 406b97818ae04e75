"""Readers of mesh files and of their images, with a cache of the results.

The input is a mesh file with its companion files; the output is `MeshPart`s in metres. Files may be hostile, so sizes,
nesting depths and references are limited. This package does not use MuJoCo.
"""
