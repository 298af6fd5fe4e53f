"""Joined faces from the command line: planned, written, judged, posted."""

import json
from pathlib import Path

import pytest

from toolaxis.cli.main import main

SKIN = Path(__file__).parents[2] / "examples" / "skin.step"


def test_joined_faces_go_all_the_way(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("OCP")
    out = tmp_path / "out"
    assert main(["plan", str(SKIN), "--tool=ball:16", "--scallop=0.5", "--method=normal", "--faces=4+9", "--out",
                 str(out), "--no-pictures"]) == 0
    said = capsys.readouterr()
    assert "4+9" in said.out
    document = json.loads((out / "plan.json").read_text())
    assert [op["faces"] for op in document["operations"]] == [[4, 9]]
    assert document["part"]["joined"] == [[4, 9]] and document["part"]["faces"] == 18
    assert {"op01-face4+9.apt", "part.step"} <= {path.name for path in out.iterdir()}
    assert main(["verify", str(out), "--no-pictures"]) == 0
    judged = json.loads((out / "verdict.json").read_text())
    assert [op["faces"] for op in judged["operations"]] == [["4", "9"]]
    assert main(["post", str(out), "--dialect=heidenhain", "--machine=mikron-ucp-710"]) == 0


def test_what_does_not_join_is_said_in_one_sentence(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("OCP")
    assert main(["plan", str(SKIN), "--tool=ball:16", "--scallop=0.5", "--faces=1+2", "--out",
                 str(tmp_path / "out")]) == 2
    assert "face 2 does not continue any of the others smoothly: machine it by itself" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_skins_are_listed_and_chosen_by_their_numbers(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("OCP")
    assert main(["inspect", str(SKIN)]) == 0
    assert "1+4+5+9+11+18" in capsys.readouterr().out
    assert main(["inspect", str(SKIN), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["skins"] == [[1, 4, 5, 9, 11, 18]]
    out = tmp_path / "out"
    assert main(["plan", str(SKIN), "--tool=ball:20", "--scallop=1", "--method=normal", "--skins=1", "--out", str(out),
                 "--no-pictures"]) == 0
    assert [op["faces"] for op in json.loads((out / "plan.json").read_text())["operations"]] == [[1, 4, 5, 9, 11, 18]]
    capsys.readouterr()
    for more, said in ((["--skins=2"], "skin 2 does not exist"), (["--skins=1+2"], "skins '1+2' is not understood"),
                       (["--skins=1", "--faces=1"], "are both given")):
        assert main(["plan", str(SKIN), "--tool=ball:20", "--scallop=1", *more, "--out", str(tmp_path / "no")]) == 2
        assert said in capsys.readouterr().err
    assert not (tmp_path / "no").exists()
