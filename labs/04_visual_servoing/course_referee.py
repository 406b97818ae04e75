"""Referee of part 5: it compares each command with the law of the course, and measures where the robot stops.

The topics below `/referee` are of the type `std_msgs/msg/String`: `right`, or the student's value and the true one.
`dead_zone`, `minimum`, `proportional` and `saturation` are the four ranges of the law; `first_stop` and `second_stop`
say where the ball is in the image 5.9 s and 11.5 s after the start. At 6 s, the referee moves the ball and doubles kp.
"""

from __future__ import annotations

from simkit import ModelPlugin, Pose

FIRST_STOP, SECOND_BEGIN, SECOND_STOP = 5.9, 6.0, 11.5  # [s]
PLACE = Pose((2.05, -0.1, 0.11))  # second place of the ball [m]
KP = (0.001, 0.002)  # [rad/s per pixel], of the two parts
DEAD_ZONE, LEAST, LARGEST = 5.0, 0.06, 0.2  # [pixels], [rad/s], [rad/s]
ZONES = ("dead_zone", "minimum", "proportional", "saturation")


class CourseReferee(ModelPlugin):
    after_step_rate = 50.0  # [Hz]

    def load(self, parent, params):
        self.kp, self.focal, self.error = KP[0], None, None
        self.problems = dict.fromkeys(ZONES, "there was no command in this range")
        self.wrong = set()  # ranges with a wrong command
        self.done = set()  # stops that are measured
        names = (*ZONES, "first_stop", "second_stop")
        self.topics = {name: self.advertise(f"/referee/{name}", "std_msgs/msg/String") for name in names}
        self.subscribe("/camera/camera_info", self.take_info)
        self.subscribe("/ball", self.take_ball)
        self.subscribe("/motors/cmd_vel", self.take_command)

    def take_info(self, message):
        self.focal = message.k[0]

    def take_ball(self, message):
        self.error = None if self.focal is None else message.point.x * self.focal

    def take_command(self, message):
        if self.error is None:
            return
        zone, true = self.law(self.error)
        yours = message.angular.z
        if zone in self.wrong:
            return
        self.problems[zone] = ""
        if abs(yours - true) > 1e-4:
            self.wrong.add(zone)
            self.problems[zone] = f"error {self.error:.1f} pixels: yours {yours:.3f} rad/s, true {true:.3f} rad/s"

    def law(self, error):
        """Return the range of the law and its turning speed [rad/s] for an error [pixels]."""
        wanted = self.kp * abs(error)
        sign = -1.0 if error > 0 else 1.0
        if abs(error) <= DEAD_ZONE:
            return "dead_zone", 0.0
        if wanted < LEAST:
            return "minimum", sign * LEAST
        if wanted > LARGEST:
            return "saturation", sign * LARGEST
        return "proportional", sign * wanted

    def after_step(self):
        time = self.sim.time
        if time >= FIRST_STOP and "first_stop" not in self.done:
            self.measure("first_stop")
        if time >= SECOND_BEGIN and self.kp == KP[0]:
            self.kp, self.error = KP[1], None
            self.sim.model("ball").set_pose(PLACE)
            self.sim.set_parameter("/CourseLaw", "kp", KP[1])
        if time >= SECOND_STOP and "second_stop" not in self.done:
            self.measure("second_stop")
            for zone in ZONES:
                self.topics[zone].publish({"data": self.problems[zone] or "right"})

    def measure(self, name):
        """Publish the true error of a stop: the robot stands, and the ball is in the dead zone but for 2 pixels."""
        self.done.add(name)
        camera = self.sim.link("turtlebot3::camera_rgb_optical_frame").pose
        right, _, ahead = (camera.inverse() @ self.sim.model("ball").pose).position
        turning = self.sim.link("turtlebot3::base_footprint").angular_velocity[2]
        error = float(right / ahead * (self.focal or 0.0))
        is_right = abs(error) <= DEAD_ZONE + 2.0 and abs(turning) < 0.01
        found = f"{error:.1f} pixels from the middle, turning at {turning:.3f} rad/s"
        text = f"yours {found}, true at most 5 pixels and 0 rad/s"
        self.topics[name].publish({"data": "right" if is_right else text})
