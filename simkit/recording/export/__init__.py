"""Bags as files for other tools: tables (CSV, NumPy, Parquet), pictures (PNG, MP4) and point clouds (NumPy, PLY)."""

from simkit.recording.export.bag_folder import CLOUDS, FORMATS, IMAGES, ExportedTopic, ExportOptions, export_bag

__all__ = ["CLOUDS", "FORMATS", "IMAGES", "ExportOptions", "ExportedTopic", "export_bag"]
