"""What FreeCAD's own post-processor makes of a job, read back and laid beside the path that the job was made from."""

import re

import numpy as np
from freecad.toolaxis.document.placement import matrix_of

WORD = re.compile(r"([XYZF])(-?\d+\.\d+)")
#: The last digit of the program, mm.
DIGIT = 0.001


def posted(job):
    """What FreeCAD's own post-processor for LinuxCNC writes."""
    from Path.Post.Processor import PostProcessorFactory

    job.PostProcessor, job.PostProcessorArgs = "linuxcnc", "--no-show-editor"
    return PostProcessorFactory.get_post_processor(job, "linuxcnc").export()[0][1]


def motions(text, label):
    """Where the motions of one operation of a program end, (n, 3), their codes and feed rates."""
    lines = text.partition(f"(begin operation: {label})")[2].partition("(finish operation")[0].splitlines()
    at, rows, codes, rates = {}, [], [], []
    for line in lines:
        code = line.split(" ")[0]
        if code in ("G0", "G1"):
            at |= {word: float(value) for word, value in WORD.findall(line)}
            rows.append([at.get(name, np.nan) for name in "XYZ"])
            codes.append(code)
            rates.append(at.get("F"))
    return np.array(rows), codes, rates


def check_on_cl(text, made, path, placement, motion=None):
    """The program of an operation, turned back by the plane that its job stands in, is the planned path.

    Parameters
    ----------
    text : str
        The program.
    made : App.DocumentObject
        The operation of the job.
    path : toolaxis.cldata.toolpath.ToolPath
        In the document's space at the time of planning.
    placement : FreeCAD.Placement
        Frame of the plane now.
    motion : (4, 4) array, optional
        How the part was moved since.
    """
    matrix, motion = matrix_of(placement), np.eye(4) if motion is None else motion
    points, codes, rates = motions(text, made.Label)
    tips = path.cl @ motion[:3, :3].T + motion[:3, 3]
    assert len(points) == len(tips) + 3, "up, across and down before, up after"
    wanted = (tips - matrix[:3, 3]) @ matrix[:3, :3]
    assert np.abs(points[2:-1] - wanted).max() <= DIGIT / 2 + 1e-9
    back = points[2:-1] @ matrix[:3, :3].T + matrix[:3, 3]
    assert np.linalg.norm(back - tips, axis=1).max() <= DIGIT / 2 * np.sqrt(3) + 1e-9
    assert np.array_equal([code == "G0" for code in codes[3:-1]], path.rapid[1:])
    assert codes[:3] == ["G0"] * 3 and codes[-1] == "G0"
    assert points[0, 2] == points[1, 2] == points[-1, 2] > points[2:-1, 2].max()
    assert np.array_equal(points[1, :2], points[2, :2]) and set(rates[3:]) <= {None, 1000.0, 10000.0}
