"""Shared code of the plugins that move robots: wheels, steering, tracks, odometry and transforms.

A plugin hands in joint names and commanded speeds; the modules return servo targets, odometry and transforms. The
package contains no plugin of its own except `WheelSlip` and its two Gazebo Classic variants, which differ only in their
aliases and topics.
"""
