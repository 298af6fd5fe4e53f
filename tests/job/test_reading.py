"""Cutter locations made elsewhere: read from their files, or refused in a sentence."""

from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion

TEXT = "UNITS/MM\nMULTAX/ON\nRAPID\nGOTO/0,0,9,0,0,1\nFEDRAT/500,MMPM\nGOTO/0,0,0,0,0.6,0.8\nGOTO/5,0,0\nFINI\n"


def test_an_apt_file(tmp_path: Path) -> None:
    file = tmp_path / "made-elsewhere.cls"
    file.write_text(TEXT)
    found = ta.read_cl(file)
    assert found.tip.tolist() == [[0, 0, 9], [0, 0, 0], [5, 0, 0]]
    assert np.allclose(found.axis, [[0, 0, 1], [0, 0.6, 0.8], [0, 0.6, 0.8]])
    path = found.path
    assert path.kind.tolist() == [Motion.LINK, Motion.CUT, Motion.CUT] and path.length(Motion.CUT) == 14.0


@pytest.mark.parametrize(("text", "said"), [
    (TEXT.replace("FINI\n", ""), "ends without FINI after 3 points, at line 7"),
    ("GOTO/0,0,0\nGOTO/1,0,0\nFINI\n", "tells no tool axes"),
    (TEXT.replace("UNITS/MM", "UNITS/FATHOMS"), "line 1: UNITS/FATHOMS"),
    (TEXT.replace("0.6", "nan"), "line 6"),
    ("hello\n", "is no APT CL file, for it has no GOTO, and no NC program")])
def test_what_is_no_cl_data_is_refused(text: str, said: str, tmp_path: Path) -> None:
    file = tmp_path / "wrong.cls"
    file.write_text(text)
    with pytest.raises(ta.InvalidInput, match=said):
        ta.read_cl(file)


def test_axes_need_not_be_told_where_nobody_needs_them(tmp_path: Path) -> None:
    file = tmp_path / "three-axes.cls"
    file.write_text("GOTO/0,0,0\nGOTO/1,0,0\nFINI\n")
    assert ta.read_cl(file, axes=False).axis.tolist() == [[0, 0, 1], [0, 0, 1]]


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(ta.InvalidInput, match="cannot be read"):
        ta.read_cl(tmp_path / "nothing.cls")
