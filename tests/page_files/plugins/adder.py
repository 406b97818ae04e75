import simkit


class Adder(simkit.WorldPlugin):
    """Plugin of the reader's own folder."""

    def load(self, parent, params):
        self.sums = self.advertise("/sums", "my_msgs/msg/Num")
