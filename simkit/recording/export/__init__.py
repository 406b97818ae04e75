"""Bags as files for other tools.

A bag and options enter; a folder of tables (CSV, NumPy, Parquet), images (PNG, MP4) and point clouds (NumPy, PLY)
leaves, complete or not at all.
"""

from simkit.recording.export.bag_folder import CLOUDS, FORMATS, IMAGES, ExportedTopic, ExportOptions, export_bag

__all__ = ["CLOUDS", "FORMATS", "IMAGES", "ExportOptions", "ExportedTopic", "export_bag"]
