"""STEP files that are missing, broken or misleading: one sentence each, and never a crash or a hang."""

import hashlib
import re
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from toolaxis.cad import load
from toolaxis.cad.build_part import part_from_record
from toolaxis.cad.step import worker as transfer
from toolaxis.cad.step.precheck import find_declared_unit, read_text
from toolaxis.errors import InvalidInput, MissingBackend, ToolAxisError
from toolaxis.shape.adjacency import gaps

pytest.importorskip("OCP")

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def text(tmp_path_factory, block_shape, write_step):
    """A good STEP file: a block of six planes and one cylinder, 40 x 30 x 20 mm."""
    return write_step(block_shape, tmp_path_factory.mktemp("good") / "good.step").read_text()


@pytest.fixture
def write(tmp_path):
    def file(content, name="part.step"):
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return file


@pytest.fixture
def same_process(monkeypatch):
    """Let the kernel read in this process, for tests that ask what comes out and not where."""

    def run(arguments, file, limit):
        return subprocess.CompletedProcess(arguments, transfer.main(arguments), b"", b"")

    monkeypatch.setattr("toolaxis.cad.step.read._run", run)


def refused(path, sentence, **options):
    start = time.perf_counter()
    with pytest.raises(InvalidInput, match=sentence) as caught:
        load(path, **options)
    message = str(caught.value)
    assert str(path) in message
    assert "\n" not in message
    return time.perf_counter() - start


def test_missing_folder_and_empty(tmp_path, write):
    refused(tmp_path / "nowhere.step", "does not exist: check the path")
    refused(tmp_path, "is a folder")
    refused(write(""), "is empty")
    refused(write(" \n\n"), "is empty")


def test_other_content(write, text, same_process):
    refused(write("solid cube\nfacet normal 0 0 1\n"), "not a STEP file")
    refused(write(bytes(range(256)) * 20), "not a STEP file")
    refused(write("IGES" + text), "not a STEP file")
    assert len(load(write(text, "renamed.txt")).faces) == 7


def test_truncated(write, text):
    for share in (0.05, 0.5, 0.98):
        refused(write(text[:int(len(text) * share)]), "cut short")


def test_header_alone(write, text):
    header = text[:text.index("DATA;")]
    refused(write(header + "END-ISO-10303-21;\n"), "header but no data")
    refused(write(header + "DATA;\nENDSEC;\nEND-ISO-10303-21;\n"), "header but no data")


def test_no_faces(write, text):
    refused(write(text.replace("ADVANCED_FACE", "EDGE_LOOP_X").replace("CLOSED_SHELL", "NOTHING")), "no faces")


@pytest.mark.parametrize("number", ["nan", "NaN", "-nan", "inf", "-Infinity", "1.#IND", "1.#QNAN0"])
def test_numbers_that_are_not_finite(write, text, number):
    """They make the kernel hang for good, so the text is searched first."""
    broken, count = re.subn(r"(CARTESIAN_POINT\('',\()[^,]*,", rf"\g<1>{number},", text, count=1)
    assert count == 1
    assert refused(write(broken), f"{re.escape(number)} in entity #[0-9]+: every number must be finite") < 1.0


def test_names_like_nan_are_no_numbers(write, text, same_process):
    named = text.replace("ADVANCED_FACE(''", "ADVANCED_FACE('(nan, inf)'", 1)
    assert named != text
    assert len(load(write(named)).faces) == 7


def test_a_byte_order_mark_does_no_harm(write, text, same_process):
    assert len(load(write(b"\xef\xbb\xbf" + text.encode())).faces) == 7


def test_dangling_references_and_damaged_faces(write, text, same_process):
    number = re.search(r"#(\d+) = CYLINDRICAL_SURFACE", text).group(1)
    path = write(re.sub(rf"#{number} = CYLINDRICAL_SURFACE[^;]*;", "", text))
    refused(path, rf"face 7 \(#\d+\) is damaged: #{number} is not defined in the file; repair it in the CAD system")
    part = load(path, accept_lost_faces=True)
    assert len(part.faces) == 6
    assert [face.number for face in part.faces] == [1, 2, 3, 4, 5, 6]
    (told,) = [warning for warning in part.warnings if warning.startswith("face 7 (#")]
    assert f"was left out: #{number} is not defined in the file" in told


def test_a_face_without_its_loop_is_damaged(write, text):
    broken, count = re.subn(r"(ADVANCED_FACE\(''),\([^)]*\)", r"\1,()", text, count=1)
    assert count == 1
    refused(write(broken), r"face 1 \(#[0-9]+\) is damaged: it has no loops")


def test_a_shell_keyword_with_a_flipped_bit(write, text):
    refused(write(text.replace("CLOSED_SHELL", "CLOSED_SHEML")), "no shape|lost 7 of its 7|made none of its 7")


def test_a_lost_quote_hides_no_faces(text, tmp_path):
    path = tmp_path / "quote.step"
    path.write_text(text.replace("ADVANCED_FACE(''", "ADVANCED_FACE(%'", 1))
    assert len(read_text(path).faces) == 7


def test_random_damage_never_crashes_the_caller(write, text):
    """Three flipped bits in the data: either the part comes whole, or one sentence says why not."""
    rng = np.random.default_rng(11)
    start = text.index("DATA;") + 10
    outcomes = set()
    for k in range(3):
        content = bytearray(text.encode())
        for place in rng.integers(start, len(content) - 100, 3):
            content[place] ^= 1 << int(rng.integers(7))
        try:
            part = load(write(bytes(content), f"flip{k}.step"), time_limit=60)
            outcomes.add("whole")
            assert len(part.faces) == 7
        except ToolAxisError as reason:
            outcomes.add("refused")
            assert "\n" not in str(reason)
    assert outcomes


def test_a_kernel_that_takes_too_long_is_stopped(write, text):
    assert refused(write(text), "busy for more than 0 s", time_limit=0.01) < 5.0


def test_a_kernel_that_crashes_is_survived(write, text, monkeypatch):
    """The child is killed as a crash would kill it."""
    crash = ("-c", "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)")
    monkeypatch.setattr("toolaxis.cad.step.read.COMMAND", crash)
    refused(write(text), r"crashed the CAD kernel \(signal 11\)")


def test_hash_and_source_are_kept(write, text, same_process):
    path = write(text)
    part = load(path)
    assert part.sha256 == hashlib.sha256(text.encode()).hexdigest()
    assert part.source == str(path)


@pytest.mark.parametrize("unit, factor", [("SI_UNIT($,.METRE.)", 1000.0), ("SI_UNIT(.CENTI.,.METRE.)", 10.0)])
def test_declared_units_become_millimetres(write, text, unit, factor, same_process):
    size = load(write(text)).diagonal
    part = load(write(text.replace("SI_UNIT(.MILLI.,.METRE.)", unit)))
    assert part.diagonal == pytest.approx(size * factor, rel=1e-9)
    assert part.unit in ("metre", "centimetre")
    warned = [warning for warning in part.warnings if "check the unit" in warning]
    assert len(warned) == (1 if factor == 1000.0 else 0)


def test_a_part_too_small_for_its_unit_is_warned_about(tmp_path, write_step, same_process):
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox

    warnings = load(write_step(BRepPrimAPI_MakeBox(0.2, 0.3, 0.1).Shape(), tmp_path / "small.step")).warnings
    assert any("0.3742 mm across" in text and "374.2 mm if its numbers were m" in text for text in warnings)


def test_damaged_geometry_is_warned_about(write, text, same_process):
    """A vertex moved by 5 mm: every face comes out, but the edges no longer lie on them."""
    moved, count = re.subn(r"(#\d+ = CIRCLE\('',#\d+,)5\.\)", r"\g<1>8.)", text, count=1)
    assert count == 1
    try:
        warnings = load(write(moved)).warnings
        assert any("lie off their faces" in warning for warning in warnings)
    except InvalidInput as reason:
        assert "lost" in str(reason)


@pytest.mark.parametrize("share", [0.3, 0.6, 0.99, 1.01, 2.0])
def test_gaps_are_wide_from_a_thousandth_of_the_part_on(share):
    """Of the part's true diagonal, whatever bound spares finding it."""
    record = transfer.convert(str(ROOT / "examples" / "freeform.step"))[1].record
    part = part_from_record(record)
    assert not [text for text in part.warnings if "lie off their faces" in text]
    border = record.borders[0]
    across = np.cross(border.points[-1] - border.points[0], (0.3, 0.5, 0.8))
    unit = replace(border, points=border.points + across / np.linalg.norm(across))
    step = share * 1e-3 * part.diagonal / gaps(part.faces, [unit]).max()
    moved = replace(border, points=border.points + step * across / np.linalg.norm(across))
    told = part_from_record(replace(record, borders=[moved, *record.borders[1:]])).warnings
    assert any("lie off their faces" in text for text in told) == (share > 1)


def test_the_unit_is_told_by_the_text_too():
    """Length units of all contexts, each once; those of angles, and units without a context, do not count."""
    def context(*lengths):
        bodies = [f"#{10 + k}=(LENGTH_UNIT()NAMED_UNIT(*){unit});" for k, unit in enumerate(lengths)]
        members = ",".join(f"#{10 + k}" for k in range(len(lengths)))
        return "".join(bodies) + f"#9=(GLOBAL_UNIT_ASSIGNED_CONTEXT(({members},#8))REPRESENTATION_CONTEXT('',''));"

    angle = "#8=(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.));#7=(LENGTH_UNIT()SI_UNIT(.MICRO.,.METRE.));"
    for text, unit in [(context("SI_UNIT(.MILLI.,.METRE.)"), "millimetre"), (context("SI_UNIT($, .METRE.)"), "metre"),
                       (context("CONVERSION_BASED_UNIT('INCH',#3)"), "inch"), ("", "not declared"),
                       (context("SI_UNIT(.MILLI.,.METRE.)", "SI_UNIT(.CENTI.,.METRE.)"), "millimetre, centimetre")]:
        assert find_declared_unit((angle + text).encode()) == unit


def test_a_kernel_of_another_release_is_told_and_not_blamed_on_the_file(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "toolaxis.cad.ocp.reader", None)
    kind, which, said = transfer.convert(str(tmp_path / "part.step"))
    assert (kind, which) == ("failed", MissingBackend) and "is not one that toolaxis knows" in said
