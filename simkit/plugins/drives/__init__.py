"""Shared code of the plugins that move robots: wheels, steering, tracks, odometry and transforms.

Plugins pass joint names and commanded speeds to these modules, which return servo targets, odometry and transforms. The
package also contains a few plugins: `WheelSlip` with its two Gazebo Classic variants, which differ only in their
aliases and topics, and `RobotStatePublisher` and `StaticTransforms`.
"""
