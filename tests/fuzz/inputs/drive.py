import simkit


class Drive(simkit.ModelPlugin):
    def __init__(self, speed=0.1):
        self.speed = speed

    def load(self, model, params):
        self.model = model
