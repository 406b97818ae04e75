"""Help for authors of plugins: information about plugins, skeletons of new ones, reloading in a run.

What enters: plugin classes, the name of a new plugin or the world that needs it, and files that change. What leaves:
the parameters and topics of a plugin, `docs/catalogue.md`, files with a new plugin and its test, and plugins that go on
with new code. No other room imports it but the command line.
"""
