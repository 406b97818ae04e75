"""Bags as files for other tools: tables (CSV, NumPy, Parquet), pictures (PNG, MP4) and point clouds (NumPy, PLY)."""

from simkit.sinks.export.bag import CLOUDS, FORMATS, IMAGES, Exported, Wish, export

__all__ = ["CLOUDS", "FORMATS", "IMAGES", "Exported", "Wish", "export"]
