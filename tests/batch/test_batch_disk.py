"""A batch whose folder goes away or whose disk is full stops with a sentence, and goes on afterwards."""

import json
import subprocess
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

from toolaxis.batch.run import batch
from toolaxis.errors import JobError, ToolAxisError

Jobs = list[dict[str, Any]]
Made = Callable[[int], Jobs]
NEVER: dict[str, Any] = {"tool": "ball:8", "scallop": 0.0002}


def names(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


def test_a_folder_that_is_moved_away_while_the_batch_runs(domes: Made, tmp_path: Path,
                                                           started: Callable[[], list[int]]) -> None:
    jobs, out = domes(3), tmp_path / "out"

    def move(text: str) -> None:
        if text.startswith("job ") and not (tmp_path / "away").exists():
            out.rename(tmp_path / "away")

    with pytest.raises(JobError, match="moved away"):
        batch(jobs, out, workers=1, told=move)
    assert not out.exists() and started() == []
    (tmp_path / "away").rename(out)
    again = batch(jobs, out, workers=1)
    assert again.complete and again.repeated == 1
    assert not names(out) & {".work", ".lock"}


def fill(path: Path) -> None:
    with suppress(OSError), path.open("wb", buffering=0) as file:
        while True:
            file.write(bytes(512))


def test_a_full_disk_is_a_sentence_and_nothing_is_lost(domes: Made, tmp_path: Path) -> None:
    jobs, disk = domes(8), tmp_path / "disk"
    disk.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=140k", "none", str(disk)], capture_output=True,
                      check=False).returncode:
        pytest.skip("a small disk cannot be mounted here")
    try:
        with pytest.raises(JobError, match=r"[Nn]o space left.*free some space and run the batch again"):
            batch(jobs, disk / "out", workers=1)
        done = [path.parent for path in (disk / "out").glob("*/job.json")]
        assert 0 < len(done) < 8 and all(set(json.loads((one / "job.json").read_text())["files"]) < names(one)
                                         for one in done)
        assert not names(disk / "out") & {".work", ".lock"}
        fill(disk / "full")
        with pytest.raises(ToolAxisError, match="No space left"):
            batch(jobs, disk / "out", workers=1)
        assert all((one / "job.json").exists() for one in done)
        subprocess.run(["mount", "-o", "remount,size=20m", str(disk)], check=True)
        again = batch(jobs, disk / "out", workers=1)
        assert again.complete and again.repeated == len(done)
    finally:
        subprocess.run(["umount", str(disk)], check=True)
