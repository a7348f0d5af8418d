"""In the real one: the compiled part."""


class InvalidHandle(Exception):
    """Somebody used an entity that was destroyed."""


class NodeNameNonExistentError(Exception):
    """There is no node of this name."""
