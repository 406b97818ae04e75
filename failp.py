import simkit
class F(simkit.ModelPlugin):
    def load(self,p,q): raise ValueError(1)
