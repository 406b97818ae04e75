"""Pack for authors of plugins and packs: the catalogue of all plugins, skeletons of new code, and reloading.

The tools read a class, a world or a file. They return parameters and topics, Python source or a new plugin instance. A
run imports this package only to reload a plugin whose file has changed.
"""
