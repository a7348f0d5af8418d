"""`PythonExpression`: what a Python expression gives, as text."""

from __future__ import annotations

import importlib
from typing import Any

from ..frontend.expose import expose_substitution
from ..launch_context import LaunchContext
from ..some_types import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ._parsing import arguments
from .substitution_failure import SubstitutionFailure


@expose_substitution("eval")
class PythonExpression(Substitution):
    """Evaluates an expression; the names of the modules, and what `math` has in it, may be used."""

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its arguments as they stand behind `$(eval `."""
        return cls, arguments("eval", data, ["expression", "python_modules"], 1)

    def __init__(
        self,
        expression: SomeSubstitutionsType,
        python_modules: SomeSubstitutionsType = ("math",),
    ) -> None:
        self.__expression = normalize_to_list_of_substitutions(expression)
        self.__python_modules = normalize_to_list_of_substitutions(python_modules)

    @property
    def expression(self) -> list[Substitution]:
        """The pieces of the expression."""
        return self.__expression

    @property
    def python_modules(self) -> list[Substitution]:
        """The modules whose names may be used."""
        return self.__python_modules

    def describe(self) -> str:
        """As in `PythonExpr('1 + 1')`."""
        return f"PythonExpr({' + '.join(part.describe() for part in self.expression)})"

    def perform(self, context: LaunchContext) -> str:
        """The expression's value as text.

        Raises:
            SubstitutionFailure: if it is no expression, or fails.
        """
        text = perform_substitutions(context, self.expression)
        names: dict[str, Any] = {}
        for part in self.python_modules:
            module = importlib.import_module(part.perform(context))
            names[module.__name__] = module
            if module.__name__ == "math":
                names.update(vars(module))
        try:
            return str(eval(compile(text, "<generated expression>", "eval"), {}, names))
        except Exception as error:
            reason = f"the Python expression {text!r} failed: {type(error).__name__}: {error}"
            hint = "Text that is compared needs quotes: [\"'\", LaunchConfiguration('mode'), \"' == 'fast'\"]."
            raise SubstitutionFailure(reason, hint) from error
