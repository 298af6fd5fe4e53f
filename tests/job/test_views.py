"""The maps that verify writes are read back, and a damaged file is refused."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from toolaxis.errors import InvalidInput
from toolaxis.job.files.verdict_maps import NAME, read_views, write_views


def judged(seed: int) -> tuple[SimpleNamespace, SimpleNamespace]:
    rng = np.random.default_rng(seed)
    axes = SimpleNamespace(x=np.array([1.0, 0, 0]), y=np.array([0.0, 1, 0]), origin=np.zeros(3))
    rays = [SimpleNamespace(point=rng.uniform(0, 10, (900, 3)), remaining=rng.uniform(0, 0.02, 900), spacing=0.5,
                            gouge=np.zeros(900)) for _ in range(2)]
    rays[0].remaining[5] = np.inf
    plan = SimpleNamespace(operations=[SimpleNamespace(name="op01-face1", frame=axes)])
    verdict = SimpleNamespace(operations=[SimpleNamespace(name="op01-face1", faces=("1",), maps=tuple(rays))])
    return plan, verdict


def test_what_is_written_is_read_back_and_the_same_bytes_each_time(tmp_path: Path) -> None:
    write_views(*judged(4), tmp_path)
    first = (tmp_path / NAME).read_bytes()
    write_views(*judged(4), tmp_path)
    assert (tmp_path / NAME).read_bytes() == first
    view = read_views(tmp_path)["op01-face1"]
    rays = judged(4)[1].operations[0].maps[0]
    assert np.isinf(view.scallop).any()
    finite = rays.remaining[np.isfinite(rays.remaining)]
    assert view.scallop[np.isfinite(view.scallop)].max() == np.float32(finite.max())


def test_without_a_file_there_are_no_maps(tmp_path: Path) -> None:
    assert read_views(tmp_path) == {}


@pytest.mark.parametrize("keep", [0, 100, 0.7])
def test_a_damaged_file_is_refused(tmp_path: Path, keep: float) -> None:
    write_views(*judged(5), tmp_path)
    path = tmp_path / NAME
    whole = path.read_bytes()
    path.write_bytes(whole[:int(keep * len(whole)) if keep < 1 else int(keep)])
    with pytest.raises(InvalidInput, match="run toolaxis verify again"):
        read_views(tmp_path)
