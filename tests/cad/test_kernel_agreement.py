"""Every face of real parts, evaluated by us and by the kernel at the same places."""

from itertools import pairwise

import numpy as np
import pytest
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepClass import BRepClass_FaceClassifier
from OCP.BRepGProp import BRepGProp
from OCP.BRepLProp import BRepLProp_SLProps
from OCP.gp import gp_Dir, gp_Pnt, gp_Pnt2d, gp_Vec
from OCP.GProp import GProp_GProps
from OCP.TopAbs import TopAbs_SOLID, TopAbs_State
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS

from toolaxis.cad.assembling import face_from_record
from toolaxis.cad.ocp import face_map

SUBSET = 12
POINTS = 8


def chosen(record, everything):
    """All faces, or a seeded subset with every kind of surface among them."""
    if everything or len(record.faces) <= SUBSET:
        return record.faces
    rng = np.random.default_rng(2016)
    kinds = {face.kind: face for face in record.faces}
    rest = [record.faces[k] for k in rng.choice(len(record.faces), SUBSET, replace=False)]
    return list({face.number: face for face in [*kinds.values(), *rest]}.values())


def xyz(p):
    return np.array([p.X(), p.Y(), p.Z()])


def kernel_curvature(face, u, v):
    """Normal out of the material, curvatures k1 >= k2 with their directions, or None where undefined."""
    properties = BRepLProp_SLProps(BRepAdaptor_Surface(face), float(u), float(v), 2, 1e-15)
    if not (properties.IsNormalDefined() and properties.IsCurvatureDefined()):
        return None
    d1, d2 = gp_Dir(), gp_Dir()
    if properties.IsUmbilic():
        d1 = d2 = None
    else:
        properties.CurvatureDirections(d1, d2)
    flip = face.Orientation().name == "TopAbs_REVERSED"
    k = np.array([properties.MaxCurvature(), properties.MinCurvature()])
    # the kernel's properties already turn the normal of a reversed face, but never the curvatures
    normal = xyz(properties.Normal())
    return flip, normal, k, d1, d2


def check_face(face, record, size, rng):
    ours = face_from_record(record)
    u0, u1, v0, v1 = ours.bounds
    uv = np.column_stack([rng.uniform(u0, u1, POINTS), rng.uniform(v0, v1, POINTS)])
    kernel_uv = record.map.to_kernel(uv)
    d, normal, curvature = ours.evaluate(uv), ours.normal(uv), ours.curvature(uv)
    adaptor = BRepAdaptor_Surface(face)
    stretch = np.linalg.norm(np.cross(d.su, d.sv), axis=1)
    for k in range(POINTS):
        p, du, dv = gp_Pnt(), gp_Vec(), gp_Vec()
        adaptor.D1(*map(float, kernel_uv[k]), p, du, dv)
        assert np.linalg.norm(d.point[k] - xyz(p)) <= 1e-9 * size + ours.tolerance, record.number
        if stretch[k] < 1e-6 * stretch.max() or ours.tolerance > 0:
            continue
        out = np.cross(xyz(du), xyz(dv)) * (-1 if face.Orientation().name == "TopAbs_REVERSED" else 1)
        assert np.linalg.norm(normal[k] - out / np.linalg.norm(out)) <= 1e-7, record.number
        check_curvature(face, kernel_uv[k], [c[k] for c in curvature], size, record.number)


def check_curvature(face, uv, ours, size, number):
    """To 1e-6 of the larger curvature, or of 1/size where the face is flatter than that."""
    theirs = kernel_curvature(face, *uv)
    if theirs is None:
        return
    flip, _, k, d1, d2 = theirs
    k1, k2 = (-k[1], -k[0]) if flip else (k[0], k[1])
    scale = max(abs(k1), abs(k2), 1 / size)
    assert abs(ours[0] - k1) <= 1e-6 * scale, (number, ours[0], k1)
    assert abs(ours[1] - k2) <= 1e-6 * scale, (number, ours[1], k2)
    if d1 is not None and k1 - k2 > 1e-3 * scale:
        first = xyz(d2 if flip else d1)
        assert 1 - abs(first @ ours[2]) <= 1e-10, number


@pytest.mark.parametrize("everything", [False, pytest.param(True, marks=pytest.mark.long)])
def test_points_normals_and_curvatures_agree_with_the_kernel(kernel_shape, kernel_record, everything):
    faces = face_map(kernel_shape)
    rng = np.random.default_rng(7)
    size = part_size(kernel_record)
    for record in chosen(kernel_record, everything):
        check_face(TopoDS.Face_s(faces.FindKey(record.number)), record, size, rng)


@pytest.mark.parametrize("everything", [False, pytest.param(True, marks=pytest.mark.long)])
def test_derivatives_agree_with_the_kernel_where_parameters_are_the_same(kernel_shape, kernel_record, everything):
    faces = face_map(kernel_shape)
    rng = np.random.default_rng(8)
    for record in chosen(kernel_record, everything):
        if record.map.breaks_u is not None or record.map.breaks_v is not None or record.tolerance > 0:
            continue
        ours = face_from_record(record)
        u0, u1, v0, v1 = ours.bounds
        uv = np.column_stack([rng.uniform(u0, u1, 4), rng.uniform(v0, v1, 4)])
        adaptor, d = BRepAdaptor_Surface(TopoDS.Face_s(faces.FindKey(record.number))), ours.evaluate(uv)
        for k in range(4):
            p, vectors = gp_Pnt(), [gp_Vec() for _ in range(5)]
            adaptor.D2(*map(float, uv[k]), p, *vectors)
            su, sv, suu, svv, suv = map(xyz, vectors)
            for mine, theirs in zip([x[k] for x in d[1:]], (su, sv, suu, suv, svv), strict=True):
                bound = 1e-8 * (np.linalg.norm(suu) + np.linalg.norm(svv) + np.linalg.norm(suv) + np.linalg.norm(su)
                                + np.linalg.norm(sv))
                assert np.linalg.norm(mine - theirs) <= bound, record.number


def test_loops_stay_inside_the_domain_of_their_surface(kernel_record):
    for record in kernel_record.faces:
        (u0, u1), (v0, v1) = face_from_record(record).surface.domain
        for loop in record.loops:
            assert (loop >= [u0, v0]).all()
            assert (loop <= [u1, v1]).all()


def part_size(record):
    nets = [face.control.reshape(-1, 4) for face in record.faces]
    points = np.concatenate([net[:, :3] / net[:, 3:] for net in nets])
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def border_distance(face, uv):
    """Least distance to the loops, mm, in the metric at each point."""
    d = face.evaluate(uv)
    result = np.full(len(uv), np.inf)
    for loop in face.outline:
        a, b = loop, np.roll(loop, -1, axis=0)
        for k, point in enumerate(uv):
            start, course = (x @ np.stack([d.su[k], d.sv[k]]) for x in (a - point, b - a))
            length = np.maximum((course**2).sum(1), 1e-300)
            t = np.clip(-(start * course).sum(1) / length, 0, 1)
            result[k] = min(result[k], np.linalg.norm(start + t[:, None] * course, axis=1).min())
    return result


@pytest.mark.parametrize("everything", [False, pytest.param(True, marks=pytest.mark.long)])
def test_inside_and_outside_agree_with_the_kernel_away_from_borders(kernel_shape, kernel_record, everything):
    faces = face_map(kernel_shape)
    rng = np.random.default_rng(9)
    seen = {True: 0, False: 0}
    for record in chosen(kernel_record, everything):
        kernel_face, ours = TopoDS.Face_s(faces.FindKey(record.number)), face_from_record(record)
        u0, u1, v0, v1 = ours.bounds
        uv = np.column_stack([rng.uniform(u0, u1, 20), rng.uniform(v0, v1, 20)])
        clear = border_distance(ours, uv) > 1e-4 * ours.diagonal + 2 * BRep_Tool.Tolerance_s(kernel_face)
        mine, kernel_uv = ours.contains(uv), record.map.to_kernel(uv)
        for k in np.flatnonzero(clear):
            state = BRepClass_FaceClassifier(kernel_face, gp_Pnt2d(*map(float, kernel_uv[k])), 1e-9).State()
            if state in (TopAbs_State.TopAbs_IN, TopAbs_State.TopAbs_OUT):
                assert mine[k] == (state == TopAbs_State.TopAbs_IN), (record.number, uv[k])
                seen[bool(mine[k])] += 1
    assert seen[True] > 0


@pytest.mark.parametrize("everything", [False, pytest.param(True, marks=pytest.mark.long)])
def test_faces_enclose_the_volume_that_the_kernel_says(kernel_shape, kernel_record, everything):
    """Sense, trims and surfaces of all faces of a solid at once: the divergence theorem."""
    if len(kernel_record.faces) > 100 and not everything:
        pytest.skip("more than 100 faces: run with --long")
    explorer = TopExp_Explorer(kernel_shape, TopAbs_SOLID)
    if not explorer.More():
        pytest.skip("the part has no solid")
    solid = explorer.Current()
    numbers = set(next(body.faces for body in kernel_record.bodies if body.kind == "solid"))
    if any("left out" in text for text in kernel_record.warnings):
        pytest.skip("the kernel itself finds a face of this part invalid")
    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(solid, properties, 1e-6, False, False)
    centre = xyz(properties.CentreOfMass())
    parts = [flux(face_from_record(record), centre) for record in kernel_record.faces if record.number in numbers]
    assert sum(parts) == pytest.approx(abs(properties.Mass()), abs=1e-4 * np.abs(parts).sum())


def flux(face, centre):
    """Integral of (p - centre) . n / 3 over the face.

    Green's theorem in the parameter plane: along every side of the loops, Gauss points; from each of them a ray back to
    the lower end of u, Gauss points again between all knots.
    """
    loops = [np.concatenate([loop, loop[:1]]) for loop in face.outline]
    cuts = np.unique(np.concatenate([face.surface.knots_v, np.linspace(*face.bounds[2:], 9)]))
    sides = [side_points(p, q, cuts) for loop in loops for p, q in pairwise(loop) if p[1] != q[1]]
    side, dv = np.concatenate([one[0] for one in sides]), np.concatenate([one[1] for one in sides])
    low, high = face.bounds[:2]
    total, knots = 0.0, np.unique(np.clip(face.surface.knots_u, low, high))
    knots = np.linspace(low, high, 5) if len(knots) < 4 else knots
    for a, b in pairwise(knots):
        upper = np.clip(side[:, 0], a, b)
        x, w = gauss(np.array([0.0, 1.0]), 6)
        u = a + (upper - a)[:, None] * x
        uv = np.stack([u, np.broadcast_to(side[:, 1:], u.shape)], axis=-1).reshape(-1, 2)
        d = face.evaluate(uv)
        through = np.einsum("ni,ni->n", d.point - centre, np.cross(d.su, d.sv)).reshape(u.shape)
        total += float((through @ w * (upper - a)) @ dv)
    return total * (-1 if face.flip else 1) / 3


def side_points(p, q, cuts):
    """Gauss points on a side of a loop between all cuts of v, and their weights dv."""
    at = np.sort(np.concatenate([[0.0, 1.0], (cuts - p[1]) / (q[1] - p[1])]))
    share, weight = gauss(at[(at >= 0) & (at <= 1)], 4)
    return p + share[:, None] * (q - p), weight * (q[1] - p[1])


def gauss(breaks, order):
    x, w = np.polynomial.legendre.leggauss(order)
    half, middle = np.diff(breaks)[:, None] / 2, (breaks[1:] + breaks[:-1])[:, None] / 2
    return (middle + half * x).ravel(), (half * w).ravel()
