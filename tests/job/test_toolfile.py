"""Tools from short forms, files and the library."""

import json
from pathlib import Path
from typing import Any

import pytest

from toolaxis.errors import InvalidInput, ToolAxisError
from toolaxis.job.inputs.tool_file import library, load_holder, load_tool


def fctb(folder: Path, **parameters: Any) -> str:
    path = folder / "bit.fctb"
    shape = parameters.pop("shape")
    path.write_text(json.dumps({"version": 2, "name": "x", "shape-type": shape, "parameter": parameters,
                                "attribute": {}}))
    return str(path)


@pytest.mark.parametrize("text", sorted(library()))
def test_every_tool_of_the_library_loads_and_is_named_after_its_form(text: str) -> None:
    tool = load_tool(text)
    assert tool.name == text.replace("-", ":")
    assert set(tool.outlines) == {"shank", "holder"}


def test_short_form_and_overrides() -> None:
    tool = load_tool("torus:12x1", stickout=50.0, **load_holder("10,0;10,40;25,40"))
    assert (tool.radius, tool.corner_radius, tool.stickout) == (6.0, 1.0, 50.0)
    assert tool.holder is not None and tool.holder.tolist() == [[10, 0], [10, 40], [25, 40]]
    assert load_tool("torus-12x1", stickout=70.0).stickout == 70.0


@pytest.mark.parametrize("parameters, radius, corner", [
    ({"shape": "Bullnose", "Diameter": "6.0000 mm", "CornerRadius": "1.0 mm"}, 3.0, 1.0),
    ({"shape": "bullnose", "Diameter": "6.0000 mm", "FlatRadius": "1.0 mm"}, 3.0, 2.0),
    ({"shape": "Ballend", "Diameter": '0.25 "'}, 3.175, 3.175),
    ({"shape": "Endmill", "Diameter": "0.25 in"}, 3.175, 0.0),
    ({"shape": "TaperedBallNose", "Diameter": "6 mm", "TaperAngle": "8.000 °"}, 3.0, 3.0),
])
def test_freecad_tool_bits(tmp_path: Path, parameters: dict[str, Any], radius: float, corner: float) -> None:
    tool = load_tool(fctb(tmp_path, CuttingEdgeHeight="20 mm", Length="50 mm", ShankDiameter="6 mm", **parameters))
    assert (tool.radius, tool.corner_radius, tool.flute_length) == pytest.approx((radius, corner, 20.0))
    assert tool.outlines["shank"].tolist() == [[3.0, 20.0], [3.0, 50.0]]


@pytest.mark.parametrize("text, said", [
    ("torus:12x7", "corner radius is 7.0 mm, above the radius 6.0 mm"),
    ("torus:12x0", "corner radius is 0.0 mm"),
    ("torus:-12x1", "diameter is -12.0 mm"),
    ("ball:0", "diameter is 0.0 mm"),
    ("ball:nan", "diameter is nan mm"),
    ("ball:8x1", "not understood"),
    ("no-such-tool", "nor one of the library: .*torus-12x1"),
])
def test_wrong_tools(text: str, said: str) -> None:
    with pytest.raises(InvalidInput, match=said):
        load_tool(text)


@pytest.mark.parametrize("content, said", [
    ("", "kind None"),
    ("kind = 'torus'\ndiameter = 12", "has no corner_radius"),
    ("kind = 'ball'\ndiameter = 12\ncorner_radius = 1", "unknown 'corner_radius'"),
    ("kind = 'ball'\ndiameter = 'x'", "diameter is 'x': it must be a number of mm"),
    ("kind = 'ball'\ndiameter = 8\nfeed_per_tooth = 0.1\nspindle = 9000", "without teeth"),
    ("kind = ", "not valid TOML"),
    ("kind = 'ball'\ndiameter = 8\nstickout = 40\nholder = [[-1, 0], [5, 10]]", "thinner than nothing"),
])
def test_wrong_tool_files(tmp_path: Path, content: str, said: str) -> None:
    path = tmp_path / "tool.toml"
    path.write_text(content)
    with pytest.raises(InvalidInput, match=said):
        load_tool(str(path))


@pytest.mark.parametrize("parameters, said", [
    ({"shape": "Drill", "Diameter": "5 mm"}, "is a drill"),
    ({"shape": "Endmill", "Diameter": "5 furlong"}, "Diameter is '5 furlong'"),
    ({"shape": "Bullnose", "Diameter": "5 mm"}, "has no corner_radius"),
])
def test_wrong_freecad_tool_bits(tmp_path: Path, parameters: dict[str, Any], said: str) -> None:
    with pytest.raises(ToolAxisError, match=said):
        load_tool(fctb(tmp_path, **parameters))


@pytest.mark.parametrize("text, said", [
    ("10,0;10", "neither a file nor rows"), ("", "neither"), ("ten,0;10,40", "neither"),
])
def test_wrong_holders(text: str, said: str) -> None:
    with pytest.raises(InvalidInput, match=said):
        load_holder(text)


@pytest.mark.parametrize("rows", ["-1,0;-1,40", "0,0;0,40", "10,40;10,0"])
def test_holders_that_are_no_solid(rows: str) -> None:
    with pytest.raises(InvalidInput, match="holder"):
        load_tool("ball:8", stickout=40.0, **load_holder(rows))
