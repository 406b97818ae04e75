"""Export of bags to files for other tools.

An export is a folder of tables (CSV, NumPy, Parquet), images (PNG, MP4) and point clouds (NumPy, PLY). The folder is
written completely or not at all.
"""

from simkit.recording.export.bag_folder import CLOUDS, FORMATS, IMAGES, ExportedTopic, ExportOptions, export_bag

__all__ = ["CLOUDS", "FORMATS", "IMAGES", "ExportOptions", "ExportedTopic", "export_bag"]
