"""Cameras of special kinds, with the images and messages that they compute."""
