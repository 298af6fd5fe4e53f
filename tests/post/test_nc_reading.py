"""NC programs read: those with every tip control and in machine coordinates are the path, broken ones are refused."""

import numpy as np
import pytest
from nc_plans import DATUM, each_once
from scipy.spatial.transform import Rotation
from test_moving import _plan

from toolaxis.cldata.toolpath import Motion
from toolaxis.errors import InvalidInput
from toolaxis.job.output.post import post_plan
from toolaxis.machine.kinematics import inverse
from toolaxis.machine.library import load_machine
from toolaxis.machine.setup import Mounting
from toolaxis.post.read_nc import read_nc

MIKRON = load_machine("mikron-ucp-710")
HEAD = "%\nO0001\n(A PROGRAM)\nG21 G90 G94 G54\nS8000 M3\nG0 A0. C0.\nG43.4 H1\n"
BODY = "G1 X0. Y0. Z0. A0. C0. F500.\nX1. A10.\n"


@pytest.mark.parametrize(("name", "dialect"), each_once(
    ["mikron-ucp-710", "dmg-dmu-60t", "bc-table-table", "head-head-portal"], ["fanuc", "siemens", "heidenhain"]))
def test_programs_with_control_of_the_tip_are_the_plan(name: str, dialect: str) -> None:
    machine, where = load_machine(name), np.eye(4)
    where[:3, :3] = Rotation.from_euler("z", 37, degrees=True).as_matrix()
    plan = _plan(where[:3, :3], 9.0)
    files = post_plan(plan, dialect, Mounting(machine, where))
    found = read_nc(next(text for file, text in files.items() if file.startswith("program")), machine, where)
    wanted = np.concatenate([op.path.cl - DATUM for op in plan.operations])
    axes = np.concatenate([op.path.axis for op in plan.operations])
    k = 0
    for tip, axis in zip(found.tip, found.axis, strict=True):  # points are put between where rotary axes need them
        if np.abs(tip - wanted[k]).max() <= 1.1e-3 and np.abs(axis - axes[k]).max() <= 4e-5:
            k = min(k + 1, len(wanted) - 1)
    assert k == len(wanted) - 1
    assert found.spindle == plan.inputs.spindle
    assert set(found.feedrate[np.isfinite(found.feedrate)]) == {plan.inputs.feedrate, plan.inputs.rapid}


@pytest.mark.parametrize("name", ["mikron-ucp-710", "dmg-dmu-60t", "bc-table-table", "head-head-portal",
                                  "nutating-head"])
def test_machine_coordinates_are_undone_by_the_kinematics(name: str) -> None:
    """A program made here from the inverse kinematics, coordinates counted from the part's origin with rotary axes at
    zero."""
    machine, rng, length = load_machine(name), np.random.default_rng(7), 120.0
    where = np.eye(4)
    where[:3, :3] = Rotation.from_euler("z", 20, degrees=True).as_matrix()
    where[:3, 3] = [11.0, -5.0, 30.0]
    tips = rng.uniform(-40, 40, (30, 3))
    axes = np.column_stack([0.3 * rng.normal(size=(30, 2)), np.ones(30)])
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    joints = inverse(machine, tips, axes, length, where).joints[:, 0]
    up = (where[:3, :3].T @ np.asarray(machine.spindle))[None]
    zero = inverse(machine, np.zeros((1, 3)), up, length, where).joints[0, 0]
    assert np.allclose(zero[3:], 0, atol=1e-9)
    names = [axis.name for axis in machine.rotary]
    lines = ["G21 G90 G54 G94", "S9000 M3"]
    for k, row in enumerate(joints):
        place = machine.directions @ (row[:3] - zero[:3])
        words = [f"{a}{v:.7f}" for a, v in zip("XYZ", place, strict=True)]
        words += [f"{a}{np.degrees(v):.8f}" for a, v in zip(names, row[3:], strict=True)]
        lines.append(f"{'G0' if k % 5 == 0 else 'G1'} {' '.join(words)} F{100 + k}")
    found = read_nc("\n".join([*lines, "M30"]), machine, where, length)
    assert np.allclose(found.tip, tips, atol=1e-5) and np.allclose(found.axis, axes, atol=1e-8)
    assert (found.kind == np.where(np.arange(30) % 5 == 0, Motion.LINK, Motion.CUT)).all()
    cut = found.kind == Motion.CUT
    assert (found.feedrate[cut] == 100.0 + np.flatnonzero(cut)).all() and np.isinf(found.feedrate[~cut]).all()


def test_inches_and_modal_words() -> None:
    body = "N10 G1 X1. Y0. Z0. A0. C0. F10.\nN20 X2. (ON)\nG0 Z1.\nM30\n%"
    found = read_nc(HEAD.replace("G21", "G20") + body, MIKRON)
    assert np.allclose(found.tip, [[25.4, 0, 0], [50.8, 0, 0], [50.8, 0, 25.4]])
    assert found.feedrate.tolist() == [254.0, 254.0, np.inf] and found.spindle == 8000.0


def test_calls_that_move_nothing() -> None:
    text = ("N10 G710 G90 G94 G17\nCYCLE800()\nCYCLE832(0.01,1,1)\nT1 D1\nM6\nS5000 M3\nG54\nG0 C=DC(10) A=20\n"
            "TRAORI\nORIWKS\nG1 X=1 Y=2 Z=3 A3=0 B3=0 C3=2 F800\nG1 X2 A3=0 B3=3 C3=4\nTRAFOOF\nSUPA G0 Z500 D0\nM30")
    found = read_nc(text, MIKRON)
    assert found.tip.tolist() == [[1, 2, 3], [2, 2, 3]] and np.allclose(found.axis, [[0, 0, 1], [0, 0.6, 0.8]])
    with pytest.raises(InvalidInput, match="line 2: CYCLE800"):
        read_nc(text.replace("CYCLE800()", "CYCLE800(1,\"\",0,57,0,0,0,0,10,0,0,0,0,1,0,0)"), MIKRON)


def test_vectors_of_klartext() -> None:
    text = ("0 BEGIN PGM A MM\n1 TOOL CALL 1 Z S7000\n2 L M3\n3 FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS\n"
            "4 LN X+1 Y+2 Z+3 NX+0 NY+0 NZ+1 TX+0 TY+0.6 TZ+0.8 F500\n5 LN X+2 Y+2 Z+3 TX+0 TY+0 TZ+1\n"
            "6 L M30\n7 END PGM A MM\n")
    found = read_nc(text, MIKRON)
    assert np.allclose(found.axis, [[0, 0.6, 0.8], [0, 0, 1]]) and found.feedrate.tolist() == [500.0, 500.0]


@pytest.mark.parametrize(("text", "said"), [
    (HEAD + BODY, "ends at line 9 without M2, M30 or END PGM, after 2 points"),
    (HEAD + BODY + "G2 X5. I1. J0.\nM30", "line 10: G2 is an arc"),
    (HEAD + BODY + "G1 Xnan\nM30", "line 10: .* not finite"),
    (HEAD + BODY + "X1. B5.\nM30", "line 10: B is no axis of Mikron UCP 710"),
    (HEAD.replace("G0 A0. C0.", "") + "G1 X0. Y0. Z0. F100\nM30", "line 8: C has no angle yet"),
    (HEAD.replace("G43.4 H1", "G43 H1") + BODY + "M30", "line 8: .* offset"),
    (HEAD + "G68.2 X0 Y0 Z0 I0 J10 K0\nM30", "line 8: G68.2 is a tilted plane"),
    (HEAD + BODY + "G91\nX1.\nM30", "line 11: increments"),
    (HEAD + BODY + "WHILE[#1 LT 5]DO1\nM30", "line 10: .* is not understood"),
    (HEAD + BODY + "G1 X2. F0\nM30", "line 10: feed rate 0"),
    (HEAD + "M30", "NC program has 0 points"),
    ("0 BEGIN PGM A MM\n1 CC X+1 Y+1\n2 END PGM A MM", "line 2: CC X")])
def test_broken_programs_are_refused_with_their_line(text: str, said: str) -> None:
    with pytest.raises(InvalidInput, match=said):
        read_nc(text, MIKRON)
