"""Loader of MuJoCo's own format, MJCF.

The input is a `<mujoco>` element as `Params`; the output is a world or a model of the scene, with a function that
creates a new MuJoCo specification of the same content. This package collects and checks the files that the MJCF file
refers to. The caller passes MuJoCo's parser, which defines the meaning of the file.
"""
