"""Names that ament uses."""

AMENT_PREFIX_PATH_ENV_VAR = "AMENT_PREFIX_PATH"
