"""Tools for plugin authors: the catalogue behind `simkit plugin`, skeletons, and reloading during a run.

The tools read a class, a world or a file and return facts, Python source or a new instance. A run imports this package
only to reload a plugin whose file has changed.
"""
