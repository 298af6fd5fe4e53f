"""What travels between a batch and the processes that carry out its jobs: a task there, an answer back."""

from dataclasses import dataclass, field
from typing import Any

from toolaxis.machine.machine import Machine
from toolaxis.tools.tool import Tool

#: Why a job failed: its input, a fault in planning, its process ended, its time or its memory was used up, or the disk.
CAUSES = ("input", "error", "crash", "timeout", "memory", "disk")


@dataclass(frozen=True)
class PartBytes:
    """A part as bytes, so that it can be read where its file is not.

    Attributes
    ----------
    name : str
        The file as it was named, or what the part was made from.
    content : bytes
        Of the STEP file, or of the part's JSON document where there is no file.
    sha256 : str
        Of the content.
    document : bool
        Whether it is a JSON document.
    """

    name: str
    content: bytes = field(repr=False)
    sha256: str
    document: bool = False


@dataclass(frozen=True)
class BatchTask:
    """One job, complete: it needs no file beside it.

    Attributes
    ----------
    name, key : str
        Of the job.
    part : PartBytes
    obstacles : tuple of PartBytes
    tools : tuple of Tool
        One, or a rack.
    machine : Machine or None
    options : dict
        Keyword arguments of `toolaxis.plan`.
    verify, pictures : bool
        Whether the plan is judged, and drawn.
    minutes : float or None
        After which planning stops and what is finished is kept.
    timeout : float or None
        s that the job may take.
    memory : float or None
        MB that its process may take.
    version : str
        Of the toolaxis that asks.
    earlier : tuple of dicts of str to bytes
        Files of the plans for the setups before, the first one first.
    """

    name: str
    key: str
    part: PartBytes
    obstacles: tuple[PartBytes, ...]
    tools: tuple[Tool, ...]
    machine: Machine | None
    options: dict[str, Any]
    verify: bool
    pictures: bool
    minutes: float | None
    timeout: float | None
    memory: float | None
    version: str
    earlier: tuple[dict[str, bytes], ...] = field(default=(), repr=False)


@dataclass(frozen=True)
class BatchAnswer:
    """What came of a job.

    Attributes
    ----------
    outcome : str
        "complete", "incomplete" (a face has no axis, or the verdict is fail) or "failed" (there is no plan).
    cause : str
        One of `CAUSES` where it failed, else empty.
    reason : str
        In a sentence; empty where it is complete.
    figures : dict
        Numbers for the summary; empty where it failed.
    files : dict of str to bytes
        The plan's folder; empty where it failed.
    spent : float
        s
    compiled : bool
        Whether kernels had to be compiled on the way: numbers may differ in the last digit from those of a process that
        finds them on disk.
    """

    outcome: str
    cause: str = ""
    reason: str = ""
    figures: dict[str, Any] = field(default_factory=dict)
    files: dict[str, bytes] = field(default_factory=dict, repr=False)
    spent: float = 0.0
    compiled: bool = False
