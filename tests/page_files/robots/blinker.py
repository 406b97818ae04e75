import simkit


class Blinker(simkit.ModelPlugin):
    """Plugin of an installed package."""

    def load(self, model, params):
        self.model = model
