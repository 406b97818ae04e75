"""Loader of SDF 1.0 to 1.12, with one module for each concept of the format.

The input is an `<sdf>` element as `Params`; the output is worlds, models and lights of the scene, with all poses
resolved. Included models of other formats are read by the loaders in the request; this package knows no other format.
"""
