"""Find the orange ball in the images of a camera: a solution."""

from __future__ import annotations

import math

import cv2
import numpy as np

from simkit import ModelPlugin, msgs

LOWEST, HIGHEST = (5, 170, 60), (20, 255, 255)  # hue [0 to 179], saturation and value [0 to 255] of the ball
FEWEST = 20  # pixels; fewer of them are not a ball


class BallFinder(ModelPlugin):
    def load(self, parent, params):
        self.radius = params.number("radius", required=True)  # of the ball [m]
        self.info = None  # newest message of the type sensor_msgs/msg/CameraInfo
        self.subscribe(params.text("camera_info", required=True), self.take_info)
        self.subscribe(params.text("image", required=True), self.take_image)
        self.ball = self.advertise("/ball", "geometry_msgs/msg/PointStamped")

    def take_info(self, message):
        self.info = message  # k = [focal length, 0, middle column, 0, focal length, middle row, 0, 0, 1], in pixels

    def take_image(self, message):
        image = msgs.image(message)  # shape (height, width, 3), red first, whatever the encoding of the camera is
        found = self.find(image) if self.info is not None else None
        if found is None:
            return  # no ball in this image
        x, y, area = found
        point = {"x": float(x), "y": float(y), "z": self.distance(x, y, area)}
        self.ball.publish({"header": message.header, "point": point})

    def find(self, image):
        """Return the coordinates x, y of the ball in the image (no unit), and its area [pixels]; None without a ball.

        x = 0, y = 0 is the middle of the image; x grows to the right and y downwards.
        """
        mask = cv2.inRange(cv2.cvtColor(image, cv2.COLOR_RGB2HSV), LOWEST, HIGHEST)
        rows, columns = np.nonzero(mask)
        if len(rows) < FEWEST:
            return None
        focal, middle_column, middle_row = self.info.k[0], self.info.k[2], self.info.k[5]
        # the middle of the first pixel is half a pixel from the edge
        x = (columns.mean() + 0.5 - middle_column) / focal
        y = (rows.mean() + 0.5 - middle_row) / focal
        return x, y, len(rows)

    def distance(self, x, y, area):
        """Return the distance of the ball along the view [m], from the area of its image."""
        focal = self.info.k[0]
        return self.radius * math.sqrt(1 + math.pi * focal**2 / area) * (1 + x * x + y * y) ** 0.25
