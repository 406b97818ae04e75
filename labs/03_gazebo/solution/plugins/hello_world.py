"""Say hello when the world is loaded: a solution."""

from __future__ import annotations

from simkit import WorldPlugin


class HelloWorld(WorldPlugin):
    filenames = ("libgazebo_tutorials.so",)

    def load(self, parent, params):
        self.log.info(params.text("greeting", "Hello World!"))
