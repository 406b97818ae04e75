"""Typical mistakes of the lab `03_gazebo`."""

GREETING = 'self.log.info(params.text("greeting", "Hello World!"))'
EVERY_STEP = f"""\
pass

    def after_step(self):
        {GREETING.replace("params", "self.params")}"""

MISTAKES = {
    "greets at every step": (
        "it greets once",
        "plugins/hello_world.py",
        GREETING,
        EVERY_STEP,
    ),
    "writes angles in degrees": (
        "the sensor is turned as its description says",
        "models/solar_waffle/model.sdf",
        "0 0.2 1.5707963",
        "0 11.46 90",
    ),
    "measures in the axes of the world": (
        "the direction of the sun is right to 0.1 degrees",
        "plugins/solar_sensor.py",
        "self.link.pose.inverse().transform(self.light.pose.position)",
        "self.light.pose.position - self.link.pose.position",
    ),
}
