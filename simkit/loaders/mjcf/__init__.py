"""MuJoCo's own format, MJCF.

A `<mujoco>` enters as `Params`; a world or a model of the scene leaves, with a way to make MuJoCo's specification
again. The files that it names are gathered and checked here; the parser that says what they mean is passed in.
"""
