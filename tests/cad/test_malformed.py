"""Malformed variants of real parts: each is read with all its faces, or with a word about those it lacks, or refused.

The variants are made from the text of the parts, whoever wrote them; nothing of the reader is used for it.
"""

import gzip
import re
import tempfile
from pathlib import Path

import pytest

from toolaxis.cad import load
from toolaxis.errors import InvalidInput

pytest.importorskip("OCP")
EXAMPLES = Path(__file__).parents[2] / "examples"
OWN = ("hyperbolic_paraboloid", "saddle")
OTHERS = ("axom_sliced_cylinder.step", "nacelle.stp", "tm_featuretype.step", "tailskin.step")
#: Those that are read in a moment, for variants that come through.
QUICK = (*OWN, "axom_sliced_cylinder.step")
NUMBER = r"[-+.0-9E]+"
DEFINED = r"#(\d+)\s*=\s*"


class Step:
    """The text of a part, and where its entities are."""

    def __init__(self, path):
        self.text = path.read_bytes().decode("latin-1")
        self.numbers = [int(n) for n in re.findall(DEFINED, self.text)]
        self.faces = [int(n) for n in re.findall(DEFINED + "ADVANCED_FACE", self.text)]
        shells = re.findall(r"=\s*(?:CLOSED|OPEN)_SHELL\s*\(\s*'[^']*'\s*,\s*\(([^)]*)", self.text)
        self.order = [int(n) for shell in shells for n in re.findall(r"#(\d+)", shell)]

    def entity(self, keyword, index=0):
        """Number and text of an entity of a kind; the test is skipped where there is none."""
        found = list(re.finditer(DEFINED + keyword + r"\s*\([^;]*;", self.text))
        if not found:
            pytest.skip(f"the part has no {keyword}")
        return int(found[index].group(1)), found[index].group()

    def of(self, number):
        """The text of an entity."""
        return re.search(rf"(?<!\d)#{number}\s*=[^;]*;", self.text).group()

    def changed(self, old, new):
        assert self.text.count(old) >= 1 and old != new
        return self.text.replace(old, new, 1)

    def substituted(self, keyword, pattern, new, index=0):
        """The text with something else in the first entity of a kind."""
        _, whole = self.entity(keyword, index)
        other, count = re.subn(pattern, new, whole, count=1, flags=re.S)
        assert count == 1, (pattern, whole[:200])
        return self.changed(whole, other)

    def with_point(self, word, number=None):
        """The text with another first coordinate in a point: the first control point of a surface, or the plane's."""
        number = number or self.surface_point()
        whole = self.of(number)
        other, count = re.subn(rf"(\(\s*'[^']*'\s*,\s*\(\s*){NUMBER}", rf"\g<1>{word}", whole, count=1)
        assert count == 1
        return self.changed(whole, other)

    def surface_point(self):
        spline = r"B_SPLINE_SURFACE_WITH_KNOTS\s*\(\s*'[^']*'\s*,\s*\d+\s*,\s*\d+\s*,[\s(]*#(\d+)"
        found = re.search(DEFINED + spline, self.text)
        if found:
            return int(found.group(2))
        placement = re.search(DEFINED + r"PLANE\s*\(\s*'[^']*'\s*,\s*#(\d+)", self.text).group(2)
        return int(re.search(r"#(\d+)", self.of(placement).partition("=")[2]).group(1))

    def last(self, more):
        """The text with more at the end of its data."""
        return re.sub(r"ENDSEC\s*;(?=\s*END-ISO)", lambda end: f"{more}\n{end.group()}", self.text)


def cut(share):
    return lambda step: step.text[:int(len(step.text) * share)]


def cut_and_closed(step):
    return step.text[:len(step.text) * 2 // 3].rpartition(";")[0] + ";\nENDSEC;\nEND-ISO-10303-21;\n"


def without(keyword):
    return lambda step: step.changed(step.entity(keyword)[1], "")


def twice(step):
    start, end = step.text.index("DATA;") + 5, step.text.rindex("ENDSEC")
    return step.text[:end] + step.text[start:end] + step.text[end:]


def header_alone(step):
    return step.text[:step.text.index("DATA;")] + "DATA;\nENDSEC;\nEND-ISO-10303-21;\n"


def on_itself(keyword, pattern):
    """An entity that refers to itself where a pattern's second group stands."""
    def change(step):
        number, _ = step.entity(keyword)
        return step.substituted(keyword, pattern, rf"\g<1>#{number}")

    return change


def in_spline(pattern, new):
    return lambda step: step.substituted("B_SPLINE_SURFACE_WITH_KNOTS", pattern, new)


def with_unit(new):
    def change(step):
        changed, count = re.subn(r"SI_UNIT\s*\(\s*(\.\w+\.|\$)\s*,\s*\.METRE\.\s*\)", new, step.text)
        assert count
        return changed

    return change


def unit_of_itself(step):
    """A length unit that is so many of a measure in that very unit."""
    number = int(re.search(DEFINED + r"\(\s*LENGTH_UNIT", step.text)[1])
    measure = max(step.numbers) + 1
    unit = f"#{number}=(CONVERSION_BASED_UNIT('ELL',#{measure})LENGTH_UNIT()NAMED_UNIT(*));"
    text = step.changed(step.of(number), unit)
    return text.replace(unit, f"{unit}\n#{measure}=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(2.),#{number});", 1)


LENGTH_UNIT = DEFINED + r"\(\s*(CONVERSION_BASED_UNIT[^;]*?)?LENGTH_UNIT[^;]*;"
MULTIPLICITIES = r"(\.[TFU]\.\s*,\s*\.[TFU]\.\s*,\s*\.[TFU]\.\s*,\s*\(\s*)\d+"
KNOTS = rf"(\(\s*)({NUMBER})((?:\s*,\s*{NUMBER})*?\s*,\s*)({NUMBER})(\s*\)\s*,\s*\.\w+\.\s*\)\s*;)$"
DAMAGED = r"face (\d+ \()?#\d+\)? is damaged(, and \d+ more faces?: first,|:) "

#: What is refused, and what the sentence says.
REFUSED = {
    "cut at a tenth": (cut(0.1), "is cut short: END-ISO-10303-21 is missing"),
    "cut in the middle": (cut(0.5), "is cut short: END-ISO-10303-21 is missing"),
    "cut before the last byte": (lambda step: step.text.rstrip()[:-2], "is cut short: END-ISO-10303-21 is missing"),
    "cut and closed": (cut_and_closed, r"is damaged(, and \d+ more faces?: first,|:) #\d+ is not defined in the file|"
                                       r"lacks #\d+, by which it declares its length unit"),
    "without ENDSEC": (lambda step: re.sub(r"ENDSEC\s*;(?=\s*END-ISO)", "", step.text), "ENDSEC is missing"),
    "header alone": (header_alone, "has a header but no data"),
    "empty": (lambda step: "", "is empty: export"),
    "blank": (lambda step: " \r\n\n", "is empty: export"),
    "packed": (lambda step: gzip.compress(step.text.encode("latin-1")),
               "but packed with gzip: unpack"),
    "zipped": (lambda step: b"PK\x03\x04" + bytes(500), "is not a STEP file but a zip archive: unpack"),
    "binary": (lambda step: bytes(range(256)) * 40, "is not a STEP file: it does not begin with ISO-10303-21"),
    "a mesh": (lambda step: "solid a\nfacet normal 0 0 1\n", "is not a STEP file but an STL mesh"),
    "a web page": (lambda step: "<!DOCTYPE html><html>404</html>", "is not a STEP file but a web page"),
    "a pointer": (lambda step: "version https://git-lfs.github.com/spec/v1\noid 1\n", "but a pointer of Git LFS"),
    "XML": (lambda step: '<?xml version="1.0"?><n0:Uos/>', "but an XML file: an assembly in XML"),
    "broken UTF-16": (lambda step: b"\xff\xfe" + step.text.encode("utf-16-le")[:999], "begins in UTF-16 and is no"),
    "NaN": (lambda step: step.with_point("NaN"), r"holds NaN in entity #\d+: every number must be finite"),
    "minus infinity": (lambda step: step.with_point("-inf"),
                       r"holds -inf in entity #\d+: every number must be finite"),
    "1E400": (lambda step: step.with_point("1.E+400"), r"holds 1.E\+400 in entity #\d+: every number must be finite"),
    "letters": (lambda step: step.with_point("abc"), r"holds abc.* in CARTESIAN_POINT #\d+, where one to three"),
    "no number": (lambda step: step.with_point(""), r"holds ,.* in CARTESIAN_POINT #\d+, where one to three numbers"),
    "decimal comma": (lambda step: step.with_point("1,5"), r"in CARTESIAN_POINT #\d+, where one to three numbers"),
    "Fortran": (lambda step: step.with_point("1.D+01"), r"holds 1.D\+01 in entity #\d+, where a number is needed"),
    "half a number": (lambda step: step.with_point("1.E+"), r"holds 1.E\+ in entity #\d+, where a number is needed"),
    "a sign": (lambda step: step.substituted("EDGE_CURVE", r"#\d+(\s*,\s*\.[TF]\.)", r"-\1"),
               r"holds - in entity #\d+, where a number is needed"),
    "a point twice": (lambda step: step.last(f"#{step.numbers[-1]}=CARTESIAN_POINT('',(0.,0.,0.));"),
                      r"defines entity #\d+ more than once: every number must stand for one entity; export"),
    "a face twice": (lambda step: step.last(step.of(step.faces[0])), r"defines entity #\d+ more than once"),
    "everything twice": (twice, r"defines entity #\d+, and \d+ other numbers, more than once"),
    "a lost semicolon": (lambda step: step.substituted("ADVANCED_FACE", ";", ""), r"lacks a semicolon before entity #"),
    "a lost bracket": (lambda step: step.substituted("EDGE_CURVE", r"\)\s*;", ";"),
                       r"has brackets that do not match in entity #\d+"),
    "an unknown unit": (with_unit("SI_UNIT(.MILLI.,.FURLONG.)"),
                        r"declares the length unit MILLI FURLONG in #\d+, which is unknown; export the part in mm"),
    "an unknown prefix": (with_unit("SI_UNIT(.FOO.,.METRE.)"), "declares the length unit FOO METRE in #"),
    "a unit of itself": (unit_of_itself, r"declares the length unit #\d+, which is defined by itself; export the part"),
    "a dangling surface": (without("(?:B_SPLINE_SURFACE_WITH_KNOTS|PLANE)"),
                           DAMAGED + r"#\d+ is not defined in the file"),
    "a dangling face": (without("ADVANCED_FACE"), DAMAGED + r"#\d+ is not defined in the file"),
    "a dangling edge": (without("EDGE_CURVE"), DAMAGED + r"#\d+ is not defined in the file"),
    "a dangling point": (lambda step: step.changed(step.of(step.surface_point()), ""),
                         DAMAGED + r"#\d+ is not defined in the file"),
    "a dangling unit": (lambda step: re.sub(LENGTH_UNIT, "", step.text),
                        r"lacks #\d+, by which it declares its length unit; export the part in mm"),
    "a face without loops": (lambda step: step.substituted("ADVANCED_FACE", r"('[^']*'\s*,\s*)\([^)]*\)", r"\1()"),
                             DAMAGED + "it has no loops; repair"),
    "a loop without edges": (lambda step: step.substituted("EDGE_LOOP", r"('[^']*'\s*,\s*)\([^)]*\)", r"\1()"),
                             DAMAGED + r"EDGE_LOOP #\d+ has no edges"),
    "a loop in itself": (on_itself("EDGE_LOOP", r"('[^']*'\s*,\s*\(\s*)#\d+"),
                         DAMAGED + r"EDGE_LOOP #(\d+) refers to #\3, an EDGE_LOOP and not an ORIENTED_EDGE"),
    "an edge of itself": (on_itself("ORIENTED_EDGE", r"('[^']*'\s*,\s*\*\s*,\s*\*\s*,\s*)#\d+"),
                          DAMAGED + r"ORIENTED_EDGE #(\d+) refers to #\3, an ORIENTED_EDGE and not an EDGE_CURVE"),
    "a face on itself": (on_itself("ADVANCED_FACE", r"('[^']*'\s*,\s*\([^)]*\)\s*,\s*)#\d+"),
                         DAMAGED + r"ADVANCED_FACE #(\d+) refers to #\3, an ADVANCED_FACE and not a surface"),
    "a shell of itself": (on_itself("(?:CLOSED|OPEN)_SHELL", r"('[^']*'\s*,\s*\(\s*)#\d+"),
                          r"lists #\d+, an? (CLOSED|OPEN)_SHELL and no face"),
    "knots that fall": (in_spline(KNOTS, r"\1\4\3\2\5"), DAMAGED + r"B_SPLINE_SURFACE_WITH_KNOTS #\d+ has knots in v "
                        "that do not ascend"),
    "a negative multiplicity": (in_spline(MULTIPLICITIES, r"\g<1>-3"), "has a knot in u of multiplicity -3, and must"),
    "too many knots": (in_spline(MULTIPLICITIES, r"\g<1>40"), r"has \d+ knots in u where \d+ control points of degree"),
    "a degree of 0": (in_spline(r"('[^']*'\s*,\s*)\d+", r"\g<1>0"), "has degree 0 in u, and must have 1 or more"),
    "a degree of 30": (in_spline(r"('[^']*'\s*,\s*)\d+", r"\g<1>30"), r"control points (in u and|of) degree 30"),
    "a short row": (in_spline(r"(\(\s*\(\s*)#\d+\s*,", r"\1"),
                    "has rows of control points that are not equally long"),
    "no control points": (in_spline(r"(\d+\s*,\s*\d+\s*,\s*)\(\s*\(.*?\)\s*\)", r"\1()"), "has no control points"),
    "an endless knot": (in_spline(r"([\d.]+)(\s*\)\s*,\s*\.\w+\.\s*\)\s*;)", r"1.E+300\2"), "has the knot 1e[+]300 in"),
    "no radius": (lambda step: step.substituted("CYLINDRICAL_SURFACE", rf",\s*{NUMBER}(\s*\)\s*;)", r",0.\1"),
                  DAMAGED + r"the radius of CYLINDRICAL_SURFACE #\d+ is 0 and must be above 0"),
    "a plane without direction": (
        lambda step: step.changed(direction(step), re.sub(r"\(\s*[-+.0-9E, \n]*\)", "(0.,0.,0.)", direction(step))),
        DAMAGED + r"DIRECTION #\d+ of AXIS2_PLACEMENT_3D #\d+ has no length"),
}


def direction(step):
    """The text of the direction of the first plane or cylinder."""
    for kind in ("PLANE", "CYLINDRICAL_SURFACE"):
        found = re.search(DEFINED + kind + r"\s*\(\s*'[^']*'\s*,\s*#(\d+)", step.text)
        if found:
            placement = step.of(found.group(2)).partition("=")[2]
            return step.of(re.findall(r"#(\d+)", placement)[1])
    pytest.skip("the part has no plane")


def latin(step):
    return step.substituted("ADVANCED_FACE", r"'[^']*'", "'Fl\u00e4che'").encode("latin-1")


def without_unit(step):
    return re.sub(r"(GLOBAL_UNIT_ASSIGNED_CONTEXT\s*\(\s*\()[^)]*(\))", r"\1\2", step.text)


#: What is read whole, and the warning that says what was mended.
WHOLE = {
    "as it is": (lambda step: step.text.encode("latin-1"), ""),
    "a byte-order mark": (lambda step: b"\xef\xbb\xbf" + step.text.encode("latin-1"), ""),
    "UTF-16": (lambda step: step.text.encode("utf-16"), "the file is written in UTF-16, which STEP does not allow"),
    "Latin-1": (latin, ""),
    "lines of DOS": (lambda step: step.text.replace("\r", "").replace("\n", "\r\n"), ""),
    "lines of old": (lambda step: step.text.replace("\r", "").replace("\n", "\r"), ""),
    "a comment first": (lambda step: "/* made; by 'someone' */\n" + step.text, ""),
    "comments inside": (lambda step: re.sub("=(\\s*)(ADVANCED_FACE)", r"= /* a 'face' */\1\2", step.text), ""),
    "an apostrophe": (lambda step: step.substituted("ADVANCED_FACE", r"'[^']*'", "'Bob's; face'"), ""),
    "garbage behind": (lambda step: step.text + "\n\0\0\0 garbage", ""),
    "named data": (lambda step: step.text.replace("DATA;", "DATA('a',('AUTOMOTIVE_DESIGN'));", 1), ""),
    "no unit": (without_unit, "declares no length unit: its numbers were taken for mm"),
}


def part_path(name, folder):
    if name in OWN:
        return EXAMPLES / f"{name}.step"
    path = folder / "parts" / name
    if not path.exists():
        pytest.skip(f"{name} is one of the parts by others: set TOOLAXIS_SHARED")
    return path


@pytest.fixture(scope="module")
def steps():
    return {}


@pytest.fixture
def step(request, steps, monkeypatch, tmp_path):
    """A part's text; what is written meanwhile goes to a folder that must be empty at the end."""
    import os

    name = request.param
    folder = Path(os.environ.get("TOOLAXIS_SHARED", EXAMPLES.parents[1] / "shared"))
    if name not in steps:
        steps[name] = Step(part_path(name, folder))
    scratch = tmp_path / "scratch"
    scratch.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(scratch))
    yield steps[name]
    assert list(scratch.iterdir()) == []


def written(content, folder, name="part.step"):
    path = folder / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode("latin-1"))
    return path


def assert_one_sentence(message, path):
    assert message.startswith(str(path)) and "\n" not in message and len(message) < 400
    assert "Traceback" not in message and "Error" not in message


def often(step, k):
    """A part and the k-th variant: all of one own part, and of the others one for each variant, in turn."""
    rest = (*OWN[1:], *OTHERS)
    return step == OWN[0] or step == rest[k % len(rest)]


@pytest.mark.parametrize("step, variant", [
    pytest.param(step, variant, marks=() if often(step, k) else pytest.mark.long)
    for step in (*OWN, *OTHERS) for k, variant in enumerate(REFUSED)], indirect=["step"])
def test_what_is_refused_says_why_in_one_sentence(step, variant, tmp_path, quick_kernel):
    change, said = REFUSED[variant]
    path = written(change(step), tmp_path)
    with pytest.raises(InvalidInput, match=said) as caught:
        load(path)
    assert_one_sentence(str(caught.value), path)


@pytest.mark.parametrize("variant", WHOLE)
@pytest.mark.parametrize("step", QUICK, indirect=True)
def test_what_does_no_harm_is_read_whole(step, variant, tmp_path, quick_kernel):
    change, said = WHOLE[variant]
    part = load(written(change(step), tmp_path))
    assert [face.number for face in part.faces] == list(range(1, len(step.faces) + 1))
    mended = [warning for warning in part.warnings if "the file" in warning and "from the file" not in warning
              and "check the unit" not in warning]
    assert len(mended) == (1 if said else 0)
    assert not said or said in mended[0]


@pytest.mark.parametrize("word", ["1.E+12", "1.E+30", "-1.E+200", "1.E+308"])
@pytest.mark.parametrize("step", ["saddle", "axom_sliced_cylinder.step", "tailskin.step"], indirect=True)
def test_a_face_with_an_absurd_length_is_left_out_and_the_others_keep_their_numbers(step, word, tmp_path, quick_kernel):
    point = step.surface_point()
    path = written(step.with_point(word, point), tmp_path)
    text, record = read(path)
    left = {number for number, why in text.order.left.items() if f"point #{point}" in why}
    assert left and left == set(text.order.left) and len(left) < len(step.faces)
    gone = {step.order.index(face) + 1 for face in left}
    assert [face.number for face in record.faces] == [n + 1 for n in range(len(step.faces)) if n + 1 not in gone]
    for number in gone:
        (told,) = [warning for warning in record.warnings if warning.startswith(f"face {number} (#")]
        assert "was left out: its coordinate in point" in told and "neither machined nor kept clear of" in told
    whole = read(written(step.text, tmp_path, "whole.step"))[1]
    places = {face.number: face.control for face in whole.faces}
    for face in record.faces:
        assert face.control.shape == places[face.number].shape
        assert face.control == pytest.approx(places[face.number], abs=1e-6)


def read(path):
    """The text of a file and what the kernel makes of it, before a part is made of that."""
    from toolaxis.cad.step.precheck import read_text
    from toolaxis.cad.step.read import _transfer

    text = read_text(path)
    return text, _transfer(path, text, 60.0).record


def command(capsys, *words):
    """Exit code, output and error lines of the command."""
    from toolaxis.cli.main import main

    try:
        code = main([str(word) for word in words])
    except SystemExit as left:
        code = int(left.code or 0)
    out, err = capsys.readouterr()
    return code, out, err.splitlines()


@pytest.mark.parametrize("variant", [
    "cut in the middle", "header alone", "binary", "packed", "NaN", "1E400", "letters", "everything twice",
    "an unknown unit", "a dangling edge", "a loop in itself", "a face without loops", "knots that fall"])
@pytest.mark.parametrize("step, verb", [
    ("saddle", "plan"), ("saddle", "inspect"), pytest.param("nacelle.stp", "plan", marks=pytest.mark.long),
    pytest.param("nacelle.stp", "inspect", marks=pytest.mark.long)], indirect=["step"])
def test_the_command_says_the_same_and_writes_nothing(step, verb, variant, tmp_path, quick_kernel, capsys):
    change, said = REFUSED[variant]
    path = written(change(step), tmp_path)
    options = ["--tool=ball:8", "--scallop=0.1", f"--out={tmp_path / 'new' / 'out'}"] if verb == "plan" else []
    code, out, lines = command(capsys, verb, path, *options)
    assert code == 2 and out == ""
    assert len(lines) == 1 and lines[0].startswith(f"toolaxis: {path}") and re.search(said, lines[0])
    assert not (tmp_path / "new").exists()


def far_wall(step):
    """The text with the plane of one wall 1e30 mm away, and the wall's number."""
    plane, whole = step.entity("PLANE", 3)
    placement = step.of(re.findall(r"#(\d+)", whole)[1])
    text = step.with_point("1.E+30", int(re.findall(r"#(\d+)", placement)[1]))
    (face,) = [face for face in step.faces if f",#{plane}," in step.of(face)]
    return text, step.order.index(face) + 1


@pytest.mark.parametrize("step", ["saddle"], indirect=True)
def test_the_command_plans_the_other_faces(step, tmp_path, quick_kernel, capsys):
    import json

    text, lost = far_wall(step)
    path = written(text, tmp_path)
    code, out, lines = command(capsys, "inspect", path, "--json")
    document = json.loads(out)
    assert code == 0 and [face["number"] for face in document["faces"]] == [n for n in range(1, 7) if n != lost]
    assert all(line.startswith("toolaxis: warning: ") for line in lines)
    assert sum(f"face {lost} (#" in line and "was left out" in line for line in lines) == 1
    planned = ("--tool=ball:16", "--scallop=0.5", "--no-pictures", f"--out={tmp_path / 'out'}")
    code, _, lines = command(capsys, "plan", path, *planned, f"--faces={lost}")
    assert code == 2 and f"face {lost} does not exist" in lines[-1]
    code, _, lines = command(capsys, "plan", path, *planned, "--faces=6")
    assert code == 0 and (tmp_path / "out" / "op01-face6.apt").exists()
    assert any(f"face {lost} (#" in line and "was left out" in line for line in lines)


@pytest.mark.parametrize("variant", ["far", "letters"])
@pytest.mark.parametrize("step", ["saddle"], indirect=True)
def test_nothing_raw_reaches_the_terminal(step, variant, tmp_path):
    """In processes of its own, as it is used: every line is one of toolaxis."""
    import subprocess
    import sys

    content = far_wall(step)[0] if variant == "far" else REFUSED[variant][0](step)
    path = written(content, tmp_path)
    ran = subprocess.run([sys.executable, "-m", "toolaxis.cli.start", "inspect", str(path)], capture_output=True,
                         text=True, timeout=300, check=False)
    assert ran.returncode == (0 if variant == "far" else 2), ran.stderr
    assert ran.stderr and all(line.startswith("toolaxis: ") for line in ran.stderr.splitlines())
