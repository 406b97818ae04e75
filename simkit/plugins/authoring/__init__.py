"""Tools for plugin authors: the catalogue that `simkit plugin` shows, skeletons of new plugins, and reloading.

The tools read a class, a world or a file. They return parameters and topics, Python source or a new plugin instance. A
run imports this package only to reload a plugin whose file has changed.
"""
