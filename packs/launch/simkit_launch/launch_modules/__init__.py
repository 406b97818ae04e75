"""Modules that launch files import: the folder `launch` here is what a launch file imports as `launch`."""
