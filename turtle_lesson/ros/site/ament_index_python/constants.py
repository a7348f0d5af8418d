"""Names that ament uses."""

AMENT_PREFIX_PATH_ENV_VAR = "AMENT_PREFIX_PATH"

RESOURCE_INDEX_SUBFOLDER = "share/ament_index/resource_index"
"""Where, below the folder that packages are installed in, their resources are listed."""
