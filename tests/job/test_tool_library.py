"""Racks of tools: libraries, tables, folders, and what is wrong with them."""

import json
import os
import random
import re
import subprocess
import sys
import zipfile
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from toolaxis.errors import InvalidInput
from toolaxis.job.inputs.tool_library import load_library, load_tools, racks
from toolaxis.messages.translate import translate
from toolaxis.tools.tool import Tool

ROOT = Path(__file__).resolve().parents[2]
HOLDERS = "[holders.ER20]\nholder = [[17, 0], [17, 60], [31.5, 74], [31.5, 100]]\n"
BALL = "[[tool]]\nkind = 'ball'\ndiameter = 8\nstickout = 50\nholder = 'ER20'\n"
TORUS = "[[tool]]\nkind = 'torus'\ndiameter = 12\ncorner_radius = 1\nstickout = 60\nholder = 'ER20'\n"


def written(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


def refused(source: Any) -> str:
    """The one sentence that says what is wrong; it has a German counterpart."""
    with pytest.raises(InvalidInput) as caught:
        load_library(source)
    said = str(caught.value)
    assert "\n" not in said and translate(said, "german") != said, said
    return said


# The rack that ships.


def test_the_general_rack_is_what_nobody_has_to_name() -> None:
    rack = load_library()
    assert rack.warnings == () and 14 <= len(rack.tools) <= 18
    assert load_tools("general-rack")[0].title == rack.tools[0].title and "general-rack" in racks()
    assert [tool.number for tool in rack.tools] == list(range(1, len(rack.tools) + 1))
    assert len({tool.title for tool in rack.tools}) == len(rack.tools)


@pytest.mark.parametrize("tool", load_tools(), ids=lambda tool: tool.title)
def test_tools_of_the_general_rack_are_those_of_a_shop(tool: Tool) -> None:
    assert tool.title and set(tool.outlines) == {"shank", "holder"}
    cutter = Tool.of(tool.kind, *map(float, tool.name.partition(":")[2].split("x")))
    assert tool.title.startswith(f"{cutter.shop_name}, ") and tool.title.endswith(f", {tool.stickout:g} out")
    shank, holder = tool.outlines["shank"], tool.outlines["holder"]
    # It is held by its shank: the bore of a shrink-fit chuck leaves a wall of 3 mm, a collet's nut is wider.
    assert shank[-1, 0] + 3 <= holder[0, 0] and shank[-1, 1] == tool.stickout
    # A cutter that leans must not cut with its shank: below the cone it is no thicker than the flutes.
    assert shank[0, 0] <= tool.profile.top_radius + 0.8
    # DIN 69893, HSK-A63: a flange of 63 mm, 26 mm wide, whose upper face is the gauge plane.
    np.testing.assert_allclose(holder[-2:], [[31.5, holder[-1, 1] - 26], [31.5, holder[-1, 1]]])
    assert 120 <= (tool.gauge_length or 0) <= 200
    assert tool.spindle is not None and tool.feedrate is not None
    assert 2000 < tool.spindle <= 20_000 and 20 < 2 * pi * tool.radius * tool.spindle / 1000 <= 250
    assert 200 < tool.feedrate < 3000


@pytest.mark.parametrize("chuck, nut", [("ER16", 28), ("ER20", 34), ("ER25", 42), ("ER32", 50)])
def test_nuts_of_the_general_rack_are_those_of_din_6499(chuck: str, nut: float) -> None:
    (held, *_) = [tool for tool in load_tools() if f", {chuck}, " in tool.title]
    assert held.outlines["holder"][1, 0] == nut / 2


def test_the_page_on_tools_does_what_it_says(tmp_path: Path) -> None:
    page = (ROOT / "resources" / "manual" / "tools.md").read_text(encoding="utf-8")
    block, = re.findall(r"```toml\n(.*?)```", page, re.DOTALL)
    written(tmp_path, "shop.toml", block)
    block, = re.findall(r"```text\n(.*?)```", page, re.DOTALL)
    table = written(tmp_path, "table.csv", block)
    assert [tool.name for tool in load_tools(table)] == ["torus:12.7x1.524", "ball:8"]
    code, = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    done = subprocess.run([sys.executable, "-W", "error", "-c", code], cwd=tmp_path, capture_output=True, text=True,
                          env={**os.environ, "PYTHONPATH": str(ROOT / "core")})
    assert done.returncode == 0, done.stderr
    said = done.stdout.splitlines()
    assert said[2] == "3 Bull nose D12 R1, ER20, 60 out" and len(said) == len(load_tools()) + 2
    assert said[-2].startswith("table.csv: 1 of 3 tools are left out")
    assert said[-1].endswith("1/2 finisher; Ball 8; Ball D8")
    assert load_tools(tmp_path / "shop.toml")[1].shop_name == "Tapered ball D6 4 deg, 55 out"
    assert '"Tapered ball D6 4 deg, 55 out"' in page


# Sources.


def test_all_sources_give_the_same_tools_and_several_come_together(tmp_path: Path) -> None:
    one, = load_tools("ball:8")
    assert one.name == "ball:8" and load_tools(one)[0] is one
    rack = written(tmp_path, "rack.toml", HOLDERS + BALL + TORUS)
    single = written(tmp_path, "single.toml", "kind = 'ball'\ndiameter = 3\n")
    names = [tool.name for tool in load_tools(str(rack))]
    assert names == [tool.name for tool in load_tools(rack)] == ["ball:8", "torus:12x1"]
    together = load_library(["flat:20", Tool.ball(6), rack, str(single), "tapered-6x3x4"])
    assert [tool.name for tool in together.tools] == ["flat:20", "ball:6", *names, "ball:3", "tapered:6x3x4"]
    assert [tool.holder is None for tool in together.tools] == [True, True, False, False, True, False]
    assert together.warnings == ("the holder is not checked of 3 of 6 tools, which have none: Flat end mill D20; "
                                 "Ball D6; Ball D3",)
    assert load_library(["flat:20", Tool.ball(6)]).warnings == ()
    assert [tool.name for tool in load_tools(tmp_path)] == [*names, "ball:3"]


def test_a_library_of_ones_own_is_found_by_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    written(tmp_path, "shop.toml", HOLDERS + TORUS)
    written(tmp_path, "table.csv", "type,diameter (mm)\nball,8\n")
    monkeypatch.setenv("TOOLAXIS_RACKS", str(tmp_path))
    assert [tool.name for tool in load_tools(["shop", "table"])] == ["torus:12x1", "ball:8"]
    assert len(load_tools()) >= 14


# TOML.


def test_a_library_states_what_a_tool_file_does_and_holders_once(tmp_path: Path) -> None:
    text = (f"note = 'ours'\nunit = 'mm'\n{HOLDERS}{TORUS}title = 'Big'\nnumber = 7\nfeedrate = 900\nspindle = 4000\n"
            f"{BALL}teeth = 2\ncutting_speed = 200\nfeed_per_tooth = 0.1\nnote = 'new'\n"
            "[[tool]]\nkind = 'ball'\ndiameter = 3\nstickout = 30\nholder = [[8, 0], [8, 50]]\n")
    torus, ball, small = load_tools(written(tmp_path, "shop.toml", text))
    assert (torus.title, torus.number, torus.feedrate, torus.spindle) == ("Big", 7, 900.0, 4000.0)
    assert ball.spindle == pytest.approx(200_000 / (8 * pi))
    assert ball.feedrate == pytest.approx(0.2 * 200_000 / (8 * pi))
    np.testing.assert_array_equal(torus.holder, ball.holder)
    assert small.holder is not None and small.holder[0, 0] == 8


@pytest.mark.parametrize("text, said", [
    ("[[tool]]\nkind = 'drill'\ndiameter = 5\n", "shop.toml, tool 1 has kind 'drill': use torus, ball"),
    ("[[tool]]\nkind = 'torus'\ntitle = 'Big'\ndiameter = 12\n",
     r"shop.toml, tool 1 \(Big\) has no corner_radius: a torus needs"),
    (BALL + "[[tool]]\nkind = 'ball'\ndiameter = nan\n", "shop.toml, tool 2: diameter is nan mm: it must be a finite"),
    ("[[tool]]\nkind = 'ball'\ndiameter = 8\nstickout = nan\n", "tool 1: stick-out is nan mm"),
    ("[[tool]]\nkind = 'ball'\ndiameter = 8\nstickout = 40\nholder = [[nan, 0], [8, 40]]\n",
     "tool 1: holder has shape"),
    ("[[tool]]\nkind = 'ball'\ndiameter = -8\n", "tool 1: diameter is -8.0 mm"),
    ("[[tool]]\nkind = 'ball'\ndiameter = 8\nlength = 8\n", "tool 1 has an unknown 'length': a ball has diameter"),
    ("[[tool]]\nkind = 'ball'\ndiameter = 8\nnumber = 0\n", "tool 1: tool number is 0: it must be a whole number"),
    ("[[tool]]\nkind = 'ball'\ndiameter = 8\nteeth = 0\n", "tool 1: number of teeth is 0"),
    ("[[tool]]\nkind = 'ball'\ndiameter = 8\nholder = 'ER40'\nstickout = 40\n",
     "tool 1: holder 'ER40' has no outline: give it as holder in a table .holders.ER40."),
    ("[holders]\nER20 = 3\n" + BALL, "tool 1: holder 'ER20' has no outline"),
    ("unit = 'inch'\n" + HOLDERS + BALL, "shop.toml is in 'inch': a TOML library is in mm; give the tools in mm"),
    ("colour = 'red'\n" + HOLDERS + BALL, "shop.toml has an unknown 'colour': a library has note, unit, holders"),
    ("tool = 3\n", "shop.toml is not a tool library"),
    (HOLDERS, "the rack shop.toml is empty: it holds no tools; end mills"),
    ("tool = []\n", "the rack shop.toml is empty"),
    (f"{HOLDERS}{BALL}number = 3\n{TORUS}number = 3\n", "shop.toml, tool 1 and shop.toml, tool 2 both have number 3"),
    (f"{HOLDERS}{BALL}title = 'Mine'\nnumber = 3\n{TORUS}title = 'Mine'\n",
     r"tool 1 \(Mine\) and shop.toml, tool 2 \(Mine\) differ and have one name, 'Mine': give each tool its own"),
])
def test_wrong_libraries(tmp_path: Path, text: str, said: str) -> None:
    path = written(tmp_path, "shop.toml", text.replace("\n\n", "\n"))
    if "[holders" not in text and "'ER20'" in text:
        path.write_text(HOLDERS + text)
    with pytest.raises(InvalidInput, match=said):
        load_library(path)
    refused(path)


def test_numbers_tell_tools_of_one_name_apart_and_twins_are_left_out(tmp_path: Path) -> None:
    text = f"{HOLDERS}{BALL}title = 'Mine'\nnumber = 3\n{TORUS}title = 'Mine'\nnumber = 4\n{BALL}number = 9\n"
    rack = load_library(written(tmp_path, "shop.toml", text))
    assert [tool.number for tool in rack.tools] == [3, 4]
    assert rack.warnings == ("shop.toml, tool 3 is the same tool as shop.toml, tool 1 (Mine): only the first one is "
                             "used",)
    # At another speed it is a tool of its own.
    other = load_tools(written(tmp_path, "other.toml", f"{HOLDERS}{BALL}number = 3\n{BALL}number = 4\nspindle = 900\n"))
    assert [tool.number for tool in other] == [3, 4]
    assert load_library(["ball:8", "ball:8"]).warnings == (
        "ball:8 is the same tool as ball:8: only the first one is used",)
    held = [Tool.ball(8, stickout=40, holder=[(wide, 0), (wide, 50)], number=wide) for wide in (12, 15)]
    assert [tool.number for tool in load_tools([*held, Tool.ball(8, stickout=50)])] == [12, 15, 0]


@pytest.mark.parametrize("source, said", [
    ([], "the rack is empty: name at least one tool"),
    ("", "tools '' is neither a short form"),
    ("no-such-rack", "nor one of the racks: general-rack, nor one of the tools: .*torus-12x1"),
    (3, "tools are 3: give a Tool"),
    (["ball:8", None], "tools are None"),
    ("ball:nan", "diameter is nan mm"),
    (["general-rack", Tool.ball(7, number=3)], r"general-rack.toml, tool 3 .* and Ball D7 both have number 3"),
])
def test_wrong_sources(source: Any, said: str) -> None:
    assert re.search(said, refused(source) if not isinstance(source, int) else _raised(source))


def _raised(source: Any) -> str:
    with pytest.raises(InvalidInput) as caught:
        load_library([source])
    return str(caught.value)


def test_wrong_files_and_folders(tmp_path: Path) -> None:
    assert "tools cannot be read from x.step: use one of .fctb, .toml" in refused(written(tmp_path, "x.step", ""))
    assert "is empty: it holds no tools" in refused(tmp_path)
    assert "is not valid TOML" in refused(written(tmp_path, "x.toml", "tool = "))


# FreeCAD.


def bit(folder: Path, name: str, shape: str, **parameters: str) -> None:
    stated = {"version": 2, "name": name.removesuffix(".fctb"), "shape": f"{shape}.fcstd",
              "parameter": {"Length": "50.0000 mm", **parameters}, "attribute": {}}
    written(folder, name, json.dumps(stated))


@pytest.mark.parametrize("bits", ["Tools/Bit", "Tools/Library", "Tools/Library/Bit"])
def test_a_freecad_library_finds_its_bits_and_leaves_out_drills(tmp_path: Path, bits: str) -> None:
    bit(tmp_path / bits, "6mm_Ball.fctb", "ballend", Diameter="6.0000 mm", CuttingEdgeHeight="12 mm",
        ShankDiameter="6 mm")
    bit(tmp_path / bits, "Quarter.fctb", "endmill", Diameter='0.25 "')
    for name, shape in (("5mm", "drill"), ("6mm", "drill"), ("M6", "tap"), ("Probe", "probe"), ("M8", "thread-mill")):
        bit(tmp_path / bits, f"{name}.fctb", shape, Diameter="5 mm")
    names = ("6mm_Ball", "5mm", "Quarter", "6mm", "M6", "Probe", "M8")
    listed = [{"nr": 10 + k, "path": f"{name}.fctb"} for k, name in enumerate(names)]
    rack = load_library(written(tmp_path, "Tools/Library/Mine.fctl", json.dumps(
        {"version": 1, "label": "Mine", "tools": listed})))
    assert [(tool.number, tool.shop_name, tool.name) for tool in rack.tools] == [
        (10, "6mm_Ball", "ball:6"), (12, "Quarter", "flat:6.35")]
    assert rack.warnings == ("Mine.fctl: 5 of 7 tools are left out, since no pass is planned with them: 2 drill, "
                             "1 probe, 1 tap, 1 thread-mill",)
    assert translate(rack.warnings[0], "german").startswith("Mine.fctl: 5 von 7 Werkzeugen bleiben weg")
    if not bits.endswith("Library"):
        assert [tool.name for tool in load_tools(tmp_path / bits)] == ["ball:6", "flat:6.35"]


def test_wrong_freecad_libraries(tmp_path: Path) -> None:
    lost = {"tools": [{"nr": 4, "path": "lost.fctb"}]}
    assert "x.fctl, tool 4: the tool bit lost.fctb is missing: put it into the folder Bit" in refused(
        written(tmp_path, "x.fctl", json.dumps(lost)))
    assert "is not a FreeCAD tool library" in refused(written(tmp_path, "y.fctl", "[]"))
    bit(tmp_path, "d.fctb", "drill", Diameter="5 mm")
    only = {"tools": [{"nr": 4, "path": "d.fctb"}]}
    assert "the rack z.fctl is empty: none of its tools can be planned with (1 drill)" in refused(
        written(tmp_path, "z.fctl", json.dumps(only)))
    bit(tmp_path, "b.fctb", "bullnose", Diameter="5 mm")
    assert "tool file b.fctb has no corner_radius" in refused(tmp_path)
    bit(tmp_path, "b.fctb", "ballend", Diameter="1.2.3 mm")
    assert "Diameter is '1.2.3 mm': a number with mm, in or deg is needed" in refused(tmp_path)


@pytest.mark.parametrize("version, kept, left", [("1.1", 4, 9), ("1.0", 3, 6)])
def test_the_library_that_comes_with_freecad(version: str, kept: int, left: int) -> None:
    folder = Path(os.environ.get("TOOLAXIS_FREECAD_FOLDERS", "/var/tmp")) / f"freecad-{version}"
    path = folder / "usr/share/freecad/Mod/CAM/Tools/Library/Default.fctl"
    if not path.is_file():
        pytest.skip(f"needs FreeCAD {version} in {folder}")
    rack = load_library(path)
    assert len(rack.tools) == kept and f"{left} of {kept + left} tools are left out" in rack.warnings[0]
    assert {"ball:6", "torus:6x1.5", "flat:5"} <= {tool.name for tool in rack.tools}


# Tables.

TABLE = """\
T,Type,Description,Diameter (mm),Corner radius [mm],Taper angle,Flute length (mm),Stick-out (mm),Shank diameter (mm),\
RPM,Feed rate (mm/min),Holder,Coolant
T1,Bull nose end mill,Roughing ,12,1,,26,60,12,5000,1500,"17,0;17,60;31,60;31,90",flood
2,ball end mill,Fine,6,3,0,12,45,6,12000,1200,ER16,
3,End mill,Corner,10,0.5,,,,,,,,
4,End mill,Sharp,10,0,,,,,,,,
5,tapered mill,Blades,6,3,4,40,65,12,,,,
6,drill,Hole,5,,,,,,,,,

7,Tap,M6,6,,,,,,,,,
"""


def test_a_table_is_read_by_its_header(tmp_path: Path) -> None:
    rack = load_library(written(tmp_path, "tools.csv", TABLE))
    assert [(tool.number, tool.title, tool.name) for tool in rack.tools] == [
        (1, "Roughing", "torus:12x1"), (2, "Fine", "ball:6"), (3, "Corner", "torus:10x0.5"), (4, "Sharp", "flat:10"),
        (5, "Blades", "tapered:6x3x4")]
    first, second = rack.tools[:2]
    assert (first.flute_length, first.stickout, first.spindle, first.feedrate) == (26.0, 60.0, 5000.0, 1500.0)
    assert first.holder is not None and first.holder.tolist() == [[17, 0], [17, 60], [31, 60], [31, 90]]
    assert second.holder is None and second.outlines["shank"].tolist() == [[3, 12], [3, 45]]
    assert rack.tools[4].outlines["shank"].tolist() == [[6, 40], [6, 65]]
    assert rack.warnings == (
        "tools.csv: 2 of 7 tools are left out, since no pass is planned with them: 1 drill, 1 tap",
        "the holder is not checked of 4 of 5 tools, which have none: Fine; Corner; Sharp; Blades")
    assert not any("holder is not" in translate(text, "german") for text in rack.warnings)


@pytest.mark.parametrize("text", [
    "type,diameter,corner radius,flute length,unit,cutting speed,feed per tooth,flutes\n"
    "bull nose,0.5,0.0625,1,inch,500,0.004,4\n",
    "type,diameter (in),corner radius (in),flute length (in),vc (m/min),fz (in),z\n"
    "bull nose,0.5,0.0625,1,152.4,0.004,4\n",
    "type;diameter;corner radius;flute length;units;vc;fz;z\nbull nose;12,7;1,5875;25,4;mm;152,4;0,1016;4\n",
    "kind\tdia\tcorner\tloc\tvc (m/min)\tfz\tteeth\nbull-nose\t12.7 mm\t1.5875mm\t25.4 mm\t152.4\t0.1016 mm\t4\n",
    '"Type (tool_type)","Diameter (tool_diameter)","Corner Radius (tool_cornerRadius)",'
    '"Flute Length (tool_fluteLength)",'
    '"Unit (tool_unit)","Unit (holder_unit)","Surface Speed (tool_surfaceSpeed)","Feed per Tooth (tool_feedPerTooth)",'
    '"Number of Flutes (tool_numberOfFlutes)","Description (holder_description)"\n'
    '"bull nose end mill","0.5","0.0625","1","inches","millimeters","500","0.004","4","CAT40"\n',
])
def test_units_of_a_table(tmp_path: Path, text: str) -> None:
    """One tool in inches and mm, by a column, by the header and by the fields, with points and commas."""
    tool, = load_tools(written(tmp_path, "tools.csv", text))
    assert (tool.radius, tool.corner_radius, tool.flute_length) == pytest.approx((6.35, 1.5875, 25.4))
    assert tool.spindle == pytest.approx(152_400 / (12.7 * pi)) and tool.title == ""
    assert tool.feedrate == pytest.approx(4 * 0.1016 * 152_400 / (12.7 * pi))


def test_rows_of_one_tool_for_several_materials_are_one_tool(tmp_path: Path) -> None:
    """Fusion writes a line for each preset; a rate that is stated counts before cutting data, which are rounded."""
    rack = load_library(written(tmp_path, "tools.csv", (
        "number,description,type,diameter (mm),spindle speed,surface speed (m/min),cutting feedrate (mm/min),"
        "feed per tooth (mm),flutes\n1,Ball,ball end mill,8,8000,201,1600,0.1,2\n"
        "1,Ball,ball end mill,8,4000,101,800,0.1,2\n"
        "2,Ball,ball end mill,8,4000,101,800,0.1,2\n")))
    assert [(tool.number, tool.spindle, tool.feedrate) for tool in rack.tools] == [
        (1, 8000.0, 1600.0), (2, 4000.0, 800.0)]
    assert rack.warnings == ("tools.csv, line 3 (Ball) is the same tool as tools.csv, line 2 (Ball): only the first "
                             "one is used",)


def test_a_shoulder_whose_diameter_nobody_states_is_as_wide_as_what_follows(tmp_path: Path) -> None:
    head = "type,diameter (mm),flute length (mm),stickout (mm),shank diameter (mm),neck length (mm)"
    bare, = load_tools(written(tmp_path, "a.csv", f"{head}\nball,2,3,30,6,12\n"))
    assert bare.outlines["shank"].tolist() == [[3, 3], [3, 12], [3, 12], [3, 30]]
    neck, = load_tools(written(tmp_path, "b.csv", f"{head},neck diameter (mm)\nball,2,3,30,6,12,1.9\n"))
    assert neck.outlines["shank"].tolist() == [[0.95, 3], [0.95, 12], [3, 12], [3, 30]]


@pytest.mark.parametrize("text, said", [
    ("", "tools.csv is empty: a header"),
    ("diameter (mm)\n8\n", "tools.csv has no column 'type': name it in the first line"),
    ("type,size (mm)\nball,8\n", "tools.csv has no column 'diameter'"),
    ("type,diameter\nball,8\n", "tools.csv, line 2: diameter has no unit: add a column unit with mm or inch"),
    ("type,diameter,unit\nball,8,cubit\n", "line 2: unit is 'cubit': use mm or inch"),
    ("type,diameter (mm)\n\nball,eight\n", "tools.csv, line 3: diameter (mm) is 'eight': a number is needed"),
    ("type,diameter (mm),name\nball,nan,Mine\n", "tools.csv, line 2 (Mine): diameter is nan mm"),
    ("type,diameter (mm)\nball,\n", "line 2 has no diameter: a ball needs diameter"),
    ("type,diameter (mm),taper angle\ntapered mill,,3\n", "line 2 has no diameter: a tapered needs diameter"),
    ("type,diameter (mm),taper angle\ntapered mill,3,\n", "line 2 has no half_angle_deg: a tapered needs diameter"),
    ("type,diameter (mm)\nball,0\n", "line 2: diameter is 0.0 mm"),
    ("type,diameter (mm)\nbull nose,8\n", "line 2 has no corner_radius"),
    ("type,diameter (mm),number\nball,8,1.5\n", "line 2: number is '1.5': a whole number is needed"),
    ("type,diameter (mm),number\nball,8,inf\n", "line 2: number is 'inf': a whole number is needed"),
    ("type,diameter (mm),shank diameter (mm),stickout (mm)\nball,8,-8,40\n", "line 2: shank diameter is -8.0 mm"),
    ("type,diameter (mm),number\nball,8,1\nball,6,1\n",
     "tools.csv, line 2 and tools.csv, line 3 both have number 1"),
    ("type,diameter (mm),stickout (mm),holder\nball,8,40,\"1;2\"\n",
     "line 2: holder '1;2' is neither a file nor rows"),
    ("type,diameter (mm)\ndrill,5\n", "the rack tools.csv is empty: none of its tools can be planned with (1 drill)"),
])
def test_wrong_tables(tmp_path: Path, text: str, said: str) -> None:
    assert said in refused(written(tmp_path, "tools.csv", text))


# Fusion.


def fusion(kind: str, description: str, number: int, unit: str = "millimeters", **geometry: float) -> dict[str, Any]:
    return {"type": kind, "unit": unit, "description": description, "geometry": geometry,
            "post-process": {"number": number}, "start-values": {"presets": [{"n": 8000, "v_f": 1000, "f_z": 0.0313}]}}


def segments(*rows: tuple[float, float, float]) -> list[dict[str, float]]:
    return [{"height": height, "lower-diameter": lower, "upper-diameter": upper} for height, lower, upper in rows]


@pytest.mark.parametrize("ending", [".json", ".tools"])
def test_a_fusion_library(tmp_path: Path, ending: str) -> None:
    ball = fusion("ball end mill", "Small", 2, DC=2, LCF=3, LB=30, OAL=50, SFDM=6, NOF=2, **{
        "shoulder-length": 10, "shoulder-diameter": 1.9})
    ball["shaft"] = {"segments": segments((5, 1.9, 6))}
    ball["holder"] = {"unit": "millimeters", "gaugeLength": 70,
                      "segments": segments((20, 28, 28), (30, 30, 50), (40, 63, 43), (30, 44, 20))}
    inch = fusion("bull nose end mill", "Half inch", 3, "inches", DC=0.5, RE=0.0625, LCF=1, LB=2, SFDM=0.5, NOF=4)
    inch["start-values"]["presets"][0]["v_f"] = 40
    inch["holder"] = {"unit": "millimeters", "segments": segments((60, 40, 50))}
    taper = fusion("tapered mill", "Blade", 4, DC=3, RE=1.500001, TA=4, LCF=20, LB=40, SFDM=6, NOF=3)
    others = [fusion("tapered mill", "Bull", 5, DC=3, RE=0.5, TA=4), fusion("drill", "D", 6, DC=3, SIG=118),
              fusion("turning general", "L", 7), {"type": "holder", "unit": "millimeters", "segments": []}]
    text = json.dumps({"data": [ball, inch, taper, *others], "version": 7})
    path = tmp_path / f"shop{ending}"
    if ending == ".tools":
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("tools.json", text)
    else:
        path.write_text(text)
    rack = load_library(path)
    assert [(tool.number, tool.title) for tool in rack.tools] == [(2, "Small"), (3, "Half inch"), (4, "Blade")]
    small, half, blade = rack.tools
    assert (small.spindle, small.feedrate, small.stickout) == (8000.0, 1000.0, 30.0)
    assert small.outlines["shank"].tolist() == [[0.95, 3], [0.95, 10], [0.95, 10], [3, 15], [3, 15], [3, 30]]
    # Up to the gauge line, 70 mm above the holder's nose: half way up the third cone.
    assert small.holder is not None
    assert small.holder.tolist() == [[14, 0], [14, 20], [15, 20], [25, 50], [31.5, 50], [26.5, 70]]
    assert (half.radius, half.corner_radius, half.stickout) == pytest.approx((6.35, 1.5875, 50.8))
    # A holder has a unit of its own.
    assert half.holder is not None and half.holder.tolist() == [[20, 0], [25, 60]]
    assert half.feedrate == pytest.approx(40 * 25.4) and blade.name == "tapered:3x1.5x4"
    assert rack.warnings == (f"shop{ending}: 3 of 6 tools are left out, since no pass is planned with them: 1 drill, "
                             "1 tapered mill, 1 turning general",
                             "the holder is not checked of 1 of 3 tools, which have none: Blade")


def test_wrong_fusion_libraries(tmp_path: Path) -> None:
    def said(name: str, *tools: Any) -> str:
        return refused(written(tmp_path, name, json.dumps({"data": tools})))

    assert "x.json, tool 1 (A): unit is 'furlongs': use millimeters or inches" in said(
        "x.json", fusion("ball end mill", "A", 1, "furlongs", DC=8))
    assert "x.json, tool 1 (A): diameter is 0.0 mm" in said("x.json", fusion("ball end mill", "A", 1))
    assert "x.json, tool 2 (B): flute length is 60.0 mm, above the stick-out 50.0 mm" in said(
        "x.json", fusion("ball end mill", "A", 1, DC=8), fusion("ball end mill", "B", 2, DC=8, LCF=60, LB=50))
    assert "x.json, tool 1 (A): diameter is nan mm" in said(
        "x.json", fusion("ball end mill", "A", 1, DC=float("nan")))
    assert "tool 1 (A) and x.json, tool 2 (B) both have number 1" in said(
        "x.json", fusion("ball end mill", "A", 1, DC=8), fusion("ball end mill", "B", 1, DC=6))
    assert "is not a Fusion tool library" in said("x.json", 3)
    assert "is not a Fusion tool library" in refused(written(tmp_path, "y.json", "{"))
    assert "y.tools cannot be read" in refused(written(tmp_path, "y.tools", "no archive"))
    assert "is not a Fusion tool library" in said("x.json", {"type": "ball end mill", "unit": "inches",
                                                             "geometry": {"DC": "a"}})


# Anything.


def spoilt(value: Any, rng: random.Random) -> Any:
    """The same data with one place taken away or replaced by something else."""
    value = json.loads(json.dumps(value))
    places: list[tuple[Any, Any]] = []
    left = [value]
    while left:
        node = left.pop()
        inner = list(node) if isinstance(node, dict) else range(len(node)) if isinstance(node, list) else ()
        places += [(node, key) for key in inner]
        left += [node[key] for key in inner]
    node, key = rng.choice(places)
    others = [None, 0, -1, 1e300, float("nan"), float("inf"), "", "12 mm", [], {}, [1], True, 2.5, 10**400]
    if rng.random() < 0.2:
        del node[key]
    else:
        node[key] = rng.choice(others)
    return value


def scrambled(text: str, rng: random.Random) -> str:
    """A text with a piece of it replaced."""
    at, length = rng.randrange(len(text)), rng.choice((0, 1, 1, 4))
    piece = rng.choice(["", "nan", "-1", "[]", "'x'", "true", "\n", "1e400", "{}", '"', ";", "T", "\t", "\0"])
    return text[:at] + piece + text[at + length:]


def test_whatever_is_wrong_in_a_file_is_one_sentence(tmp_path: Path) -> None:
    rng = random.Random(27)
    ball = fusion("ball end mill", "Small", 2, DC=2, LCF=3, LB=30, SFDM=6, NOF=2, **{"shoulder-length": 10})
    ball["shaft"] = {"segments": segments((5, 1.9, 6))}
    ball["holder"] = {"unit": "millimeters", "gaugeLength": 40, "segments": segments((20, 28, 28), (30, 30, 50))}
    bullnose = {"name": "x", "shape": "bullnose.fcstd", "parameter": {"Diameter": "6 mm", "CornerRadius": "1 mm",
                                                                      "Length": "50 mm", "ShankDiameter": "6 mm"}}
    toml = f"{HOLDERS}{BALL}{TORUS}number = 4\nteeth = 2\ncutting_speed = 200.0\nfeed_per_tooth = 0.1\n"
    kept = 0
    for _ in range(300):
        written(tmp_path, "a.fctb", json.dumps(spoilt(bullnose, rng)))
        for name, text in (("x.json", json.dumps(spoilt({"data": [ball]}, rng))),
                           ("x.fctl", json.dumps({"tools": [{"nr": 1, "path": "a.fctb"}]})),
                           ("y.fctl", json.dumps(spoilt({"tools": [{"nr": 1, "path": "a.fctb"}]}, rng))),
                           ("x.toml", scrambled(toml, rng)), ("x.csv", scrambled(TABLE, rng))):
            try:
                kept += len(load_tools(written(tmp_path, name, text)))
            except InvalidInput as reason:
                assert "\n" not in str(reason), reason
    assert kept > 300
