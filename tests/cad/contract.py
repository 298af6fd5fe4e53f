"""What every CAD adapter has to fulfil, whichever kernel it reads: our faces against the kernel's own answers.

A kernel answers through two plain objects.

A shape has `faces` (by number, from 1), `volume` (of the first solid, None where there is none), `accuracy` (of that
volume, as a share of what all faces add to it without regard to sign) and `centre` of that solid.

A face has `flip`, `tolerance`, `first(u, v)` -> (point, su, sv), `second(u, v)` -> (suu, svv, suv), `bend(u, v)` ->
(greatest and least curvature, directions of both or None) by the surface's own normal su x sv, or None, and
`inside(u, v)` -> True, False, or None on the border.
"""

from itertools import pairwise

import numpy as np
import pytest

from toolaxis.cad.build_part import face_from_record

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


def part_size(record):
    nets = [face.control.reshape(-1, 4) for face in record.faces]
    points = np.concatenate([net[:, :3] / net[:, 3:] for net in nets])
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def check_values(shape, record, everything):
    """Points to 1e-9 of the size, normals to 1e-7 rad, curvatures to 1e-6 of the larger one."""
    rng, size = np.random.default_rng(7), part_size(record)
    for item in chosen(record, everything):
        check_face(shape.faces[item.number], item, size, rng)


def check_face(kernel, record, size, rng):
    ours = face_from_record(record)
    u0, u1, v0, v1 = ours.bounds
    uv = np.column_stack([rng.uniform(u0, u1, POINTS), rng.uniform(v0, v1, POINTS)])
    kernel_uv = record.map.to_kernel(uv)
    d, normal, curvature = ours.evaluate(uv), ours.normal(uv), ours.curvature(uv)
    stretch = np.linalg.norm(np.cross(d.su, d.sv), axis=1)
    for k, (u, v) in enumerate(kernel_uv.tolist()):
        point, su, sv = kernel.first(u, v)
        assert np.linalg.norm(d.point[k] - point) <= 1e-9 * size + ours.tolerance, record.number
        if stretch[k] < 1e-6 * stretch.max() or ours.tolerance > 0:
            continue
        out = np.cross(su, sv) * (-1 if kernel.flip else 1)
        assert np.linalg.norm(normal[k] - out / np.linalg.norm(out)) <= 1e-7, record.number
        check_curvature(kernel, (u, v), [c[k] for c in curvature], size, record.number)


def check_curvature(kernel, uv, ours, size, number):
    """To 1e-6 of the larger curvature, or of 1/size where the face is flatter than that."""
    theirs = kernel.bend(*uv)
    if theirs is None:
        return
    high, low, first, second = theirs
    k1, k2, first = (-low, -high, second) if kernel.flip else (high, low, first)
    scale = max(abs(k1), abs(k2), 1 / size)
    assert abs(ours[0] - k1) <= 1e-6 * scale, (number, ours[0], k1)
    assert abs(ours[1] - k2) <= 1e-6 * scale, (number, ours[1], k2)
    if first is not None and k1 - k2 > 1e-3 * scale:
        assert 1 - abs(first @ ours[2]) <= 1e-10, number


def check_derivatives(shape, record, everything):
    """Where our parameters are the kernel's, all derivatives to second order are the same."""
    rng = np.random.default_rng(8)
    for item in chosen(record, everything):
        if item.map.breaks_u is not None or item.map.breaks_v is not None or item.tolerance > 0:
            continue
        ours, kernel = face_from_record(item), shape.faces[item.number]
        u0, u1, v0, v1 = ours.bounds
        uv = np.column_stack([rng.uniform(u0, u1, 4), rng.uniform(v0, v1, 4)])
        d = ours.evaluate(uv)
        for k, (u, v) in enumerate(uv.tolist()):
            (_, su, sv), (suu, svv, suv) = kernel.first(u, v), kernel.second(u, v)
            bound = 1e-8 * sum(np.linalg.norm(x) for x in (suu, svv, suv, su, sv))
            for mine, theirs in zip([x[k] for x in d[1:]], (su, sv, suu, suv, svv), strict=True):
                assert np.linalg.norm(mine - theirs) <= bound, item.number


def check_loops(record):
    """Loops stay inside the domain of their surface."""
    for item in record.faces:
        (u0, u1), (v0, v1) = face_from_record(item).surface.domain
        for loop in item.loops:
            assert (loop >= [u0, v0]).all()
            assert (loop <= [u1, v1]).all()


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


def check_inside(shape, record, everything):
    """Inside and outside agree with the kernel away from borders."""
    rng = np.random.default_rng(9)
    seen = {True: 0, False: 0}
    for item in chosen(record, everything):
        kernel, ours = shape.faces[item.number], face_from_record(item)
        u0, u1, v0, v1 = ours.bounds
        uv = np.column_stack([rng.uniform(u0, u1, 20), rng.uniform(v0, v1, 20)])
        clear = border_distance(ours, uv) > 1e-4 * ours.diagonal + 2 * kernel.tolerance
        mine, kernel_uv = ours.contains(uv), item.map.to_kernel(uv)
        for k in np.flatnonzero(clear):
            theirs = kernel.inside(*kernel_uv[k].tolist())
            if theirs is not None:
                assert mine[k] == theirs, (item.number, uv[k])
                seen[bool(mine[k])] += 1
    assert seen[True] > 0


def check_volume(shape, record, everything):
    """Sense, trims and surfaces of all faces of a solid at once: the divergence theorem."""
    poles = sum(face.control.shape[0] * face.control.shape[1] for face in record.faces)
    if (len(record.faces) > 100 or poles > 10000) and not everything:
        pytest.skip("more than 100 faces or 10000 control points: run with --long")
    if shape.volume is None:
        pytest.skip("the part has no solid, or the kernel tells its volume too coarsely")
    if any("left out" in text for text in record.warnings):
        pytest.skip("the kernel itself finds a face of this part invalid")
    numbers = set(next(body.faces for body in record.bodies if body.kind == "solid"))
    parts = [flux(face_from_record(item), shape.centre) for item in record.faces if item.number in numbers]
    assert sum(parts) == pytest.approx(abs(shape.volume), abs=shape.accuracy * np.abs(parts).sum())


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
