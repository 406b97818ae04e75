"""Loader of MuJoCo's own format, MJCF.

The input is a `<mujoco>` element as `Params`; the output is a world or a model of the scene, with a function that
creates MuJoCo's specification again. The files that it refers to are collected and checked here. MuJoCo's parser, which
defines their meaning, is passed in.
"""
