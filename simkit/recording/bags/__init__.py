"""Bags: MCAP files and rosbag2 folders written, read, mended, described and played back."""
