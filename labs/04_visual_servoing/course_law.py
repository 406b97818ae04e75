"""Part 5: the law of the course, in pixels, for a robot whose motors need a least speed."""

from __future__ import annotations

from simkit import ModelPlugin


class CourseLaw(ModelPlugin):
    def load(self, parent, params):
        self.kp = self.declare("kp", 0.001, minimum=0.0, description="turning speed for an error [rad/s per pixel]")
        self.dead_zone = self.declare("dead_zone", 5.0, minimum=0.0, description="error that counts as zero [pixels]")
        self.wz_min = self.declare(
            "wz_min", 0.06, minimum=0.0, description="least speed that overcomes friction [rad/s]"
        )
        self.wz_max = self.declare("wz_max", 0.2, minimum=0.0, description="largest speed [rad/s]")
        self.focal = None  # [pixels]
        self.command = self.advertise("/motors/cmd_vel", "geometry_msgs/msg/Twist")
        self.subscribe("/camera/camera_info", self.take_info)
        self.subscribe("/ball", self.take_ball)

    def take_info(self, message):
        self.focal = message.k[0]

    def take_ball(self, message):
        if self.focal is not None:
            error = message.point.x * self.focal  # column of the ball minus the middle column [pixels]
            self.command.publish({"angular": {"z": self.turn(error)}})

    def turn(self, error):
        """Return the turning speed [rad/s], positive to the left, for an error [pixels], positive to the right."""
        # Exercise: formula (6) of the README, with self.kp.value and the three other parameters.
        return 0.0
