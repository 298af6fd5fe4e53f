"""The exception family: the caller's fault is an exception, the world's answer is a result."""


class ToolAxisError(Exception):
    """Base of everything that toolaxis raises on purpose."""


class InvalidInput(ToolAxisError, ValueError):
    """A value given by the caller breaks a rule; the message names quantity, value, index, rule and remedy."""


class UnsupportedGeometry(ToolAxisError):
    """The geometry is valid but of a kind that cannot be handled; the message names it and what to do."""


class MissingBackend(ToolAxisError, ImportError):
    """An optional library that the request needs is not installed; the message says how to install it."""


class JobError(ToolAxisError):
    """A stage of a job failed on one item; the cause is chained.

    Parameters
    ----------
    stage : str
        What was being done, in the words of the progress display.
    item : str
        What it was done to ("face 7").
    message : str
        One sentence on what went wrong.
    """

    def __init__(self, stage: str, item: str, message: str) -> None:
        super().__init__(f"{stage}, {item}: {message}")
        self.stage = stage
        self.item = item
        self.message = message

    def __reduce__(self) -> tuple[type["JobError"], tuple[str, str, str]]:
        return type(self), (self.stage, self.item, self.message)


class Cancelled(ToolAxisError):
    """The user asked to stop."""
