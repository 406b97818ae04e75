"""Small scenes of the compiler's tests, and a cache of meshes for each test."""

from tests.compiler.conftest import compiled, make, own_mesh_cache

__all__ = ["compiled", "make", "own_mesh_cache"]
