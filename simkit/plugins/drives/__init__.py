"""What plugins that move robots share: wheels, steering, tracks, odometry, transforms.

Names of joints and commanded speeds enter; servo targets, odometry and transforms leave. No kind of plugin is chosen
here, but `WheelSlip` and its twins of Classic, which differ only by an alias and their topics.
"""
