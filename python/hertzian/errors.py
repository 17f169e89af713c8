"""Why there is no result: exceptions with the sentences that the library has in Rust.

Each kind of error is a class, so that a program can tell what is to be changed for an answer::

    try:
        branch = model.response(0.6, 1.6)
    except hertzian.NoOrbitError as error:
        print(error.kind, error)

Where a computation was interrupted, by Ctrl-C or by a callback that raised, the exception is the one that was raised, and has an
attribute ``result``: what was computed by then, or None.
"""

from __future__ import annotations


class HertzianError(Exception):
    """There is no result; ``str()`` is the sentence that says why."""

    #: What is to be changed for an answer: "request", "model", "no-orbit", "limit", "motion", "cancelled", "file" or "system".
    kind: str = "other"
    #: The error with everything that it carries, as text.
    details: str
    #: Which of the errors of this kind it is, as "SingularMass"; empty where the library has none.
    variant: str
    #: The numbers that it carries, by name.
    values: dict[str, float]

    def __init__(self, sentence: str, details: str = "") -> None:
        super().__init__(sentence)
        self.details = details
        self.variant = ""
        self.values = {}


class RequestError(HertzianError, ValueError):
    """The request: an option, a parameter or a name is not usable."""

    kind = "request"


class ModelError(HertzianError, ValueError):
    """The model: its declaration, its masses or its levels are not usable, or the method is not for it."""

    kind = "model"


class DeclarationError(ModelError):
    """The text of a model: ``faults`` has the line, the column and a sentence for each thing that is wrong."""

    #: Line and column, counted from one, and what is wrong there.
    faults: list[tuple[int, int, str]]

    def __init__(self, sentence: str, details: str = "", faults: list[tuple[int, int, str]] | None = None) -> None:
        super().__init__(sentence, details)
        self.faults = faults or []


class NoOrbitError(HertzianError):
    """No orbit was found where it was looked for, and more work of the same kind is not expected to find one."""

    kind = "no-orbit"


class LimitError(HertzianError):
    """The work that is allowed: a search ended before it could say that there is none."""

    kind = "limit"


class MotionError(HertzianError):
    """The motion: from its state it cannot be continued."""

    kind = "motion"


class CancelledError(HertzianError):
    """The computation was cancelled before there was a result."""

    kind = "cancelled"


class FileError(HertzianError, OSError):
    """The file: it cannot be read, written or used."""

    kind = "file"


class ResourceError(HertzianError):
    """What the operating system gives."""

    kind = "system"
