"""`SubstitutionFailure`: a substitution has no value."""


class SubstitutionFailure(RuntimeError):
    """A substitution could not be performed. `hint` says what to try."""

    def __init__(self, message: str = "", hint: str = "") -> None:
        super().__init__(message)
        self.hint = hint
