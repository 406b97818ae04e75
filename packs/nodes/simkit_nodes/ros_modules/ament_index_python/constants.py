"""Names of folders and environment variables."""

from __future__ import annotations

from typing import Final

__all__ = ["AMENT_PREFIX_PATH_ENV_VAR", "RESOURCE_INDEX_SUBFOLDER"]

RESOURCE_INDEX_SUBFOLDER: Final = "share/ament_index/resource_index"
AMENT_PREFIX_PATH_ENV_VAR: Final = "AMENT_PREFIX_PATH"
