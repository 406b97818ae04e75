"""SDF 1.0 to 1.12: one file for each concept of the format.

An `<sdf>` enters as `Params`; worlds, models and lights of the scene leave, every pose resolved. Models of other
formats that a file includes come through the loaders that the request names: this folder knows none of them.
"""
