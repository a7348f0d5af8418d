"""`FileContent`: what stands in a file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..frontend.expose import expose_substitution
from ..launch_context import LaunchContext
from ..some_types import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ._parsing import arguments
from .substitution_failure import SubstitutionFailure


@expose_substitution("file-content")
class FileContent(Substitution):
    """Stands for the text of a file."""

    def __init__(self, path: SomeSubstitutionsType) -> None:
        self.__path = normalize_to_list_of_substitutions(path)

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its argument as it stands behind `$(file-content `."""
        return cls, arguments("file-content", data, ["path"], 1)

    @property
    def path(self) -> list[Substitution]:
        """The pieces of the path."""
        return self.__path

    def describe(self) -> str:
        """As in `FileContent('notes.txt')`."""
        return f"FileContent({' + '.join(piece.describe() for piece in self.path)})"

    def perform(self, context: LaunchContext) -> str:
        """The text.

        Raises:
            SubstitutionFailure: if there is no such file.
        """
        path = perform_substitutions(context, self.path)
        try:
            return Path(path).read_text(encoding="utf-8")
        except FileNotFoundError as error:
            raise SubstitutionFailure(f"File not found: {path}") from error
        except (OSError, UnicodeDecodeError, ValueError) as error:
            raise SubstitutionFailure(f"Failed to open {path}: {error}") from error
