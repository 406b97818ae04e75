"""Say hello when the world is loaded: your plugin. Run it with `simkit lab grade .`"""

from __future__ import annotations

from simkit import WorldPlugin


class HelloWorld(WorldPlugin):
    # Exercise 1: `filenames` is a tuple of library names. A world that names one of them gets this plugin.

    def load(self, parent, params):
        # Exercise 2: `self.log.info(text)` writes a line of the log. The text is the parameter <greeting> of the world;
        # `params.text("name", "default")` reads a parameter.
        pass
