"""What can be wrong with a bag."""

from __future__ import annotations


class BagError(ValueError):
    """A bag cannot be written or read; the text says why, and what to try."""


class UnrecordableType(BagError):
    """Messages of this type cannot be put into a bag."""
