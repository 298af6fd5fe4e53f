"""What blisk and impeller share: twisted blades on a hub of revolution about z, with fillets at their roots, one solid.

One sector is made and turned: hub, four faces around a blade (suction side, trailing edge, pressure side, leading
edge), four fillets below them, and the tip.  A blade stands on stream surfaces of revolution between its root and its
tip: t runs along the flow (0 leading, 1 trailing edge), s from root to tip.  A fillet is a ball rolled along blade and
hub; the blade's faces end where it touches them.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakeSolid,
    BRepBuilderAPI_MakeWire,
    BRepBuilderAPI_Sewing,
    BRepBuilderAPI_Transform,
)
from OCP.BRepGProp import BRepGProp
from OCP.BRepLib import BRepLib
from OCP.BRepPrimAPI import BRepPrimAPI_MakeRevol
from OCP.Geom import Geom_BSplineCurve, Geom_BSplineSurface, Geom_Plane
from OCP.gp import gp_Ax1, gp_Ax2, gp_Circ, gp_Dir, gp_Pnt, gp_Trsf
from OCP.GProp import GProp_GProps
from OCP.ShapeFix import ShapeFix_Face
from scipy.interpolate import BSpline, make_interp_spline
from scipy.spatial import cKDTree

from toolaxis.cad.ocp.kernel_names import IntegerArray, PointArray, PointGrid, RealArray, as_shell, as_wire

AXIS = gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1))


@dataclass(frozen=True)
class Rotor:
    """Blades on a hub.

    Attributes
    ----------
    blades : int
    root, tip : function of t
        Meridian curves, rows (r, z), of the stream surfaces at a blade's root, below the top of the
        fillet, and at its tip.
    wrap : function of (t, s)
        Angle about the axis along the middle of the blade, rad.
    half : function of (t, s)
        Half of the blade's thickness, mm.
    caps : pair of float
        Values of t where the round edges begin.
    fillet : float
        Radius at the root, mm.
    above : function of points (n, 3)
        Height above the hub, mm.
    hub : function of (t, angle)
        Points of the hub.
    hub_ends : pair of float
        Values of t where the hub begins and ends.
    hub_surface, tip_surface : kernel surface
    sections, along, around : int
        Sections along the span; points of each along a side and around an edge.
    """

    blades: int
    root: Callable
    tip: Callable
    wrap: Callable
    half: Callable
    caps: tuple
    fillet: float
    above: Callable
    hub: Callable
    hub_ends: tuple
    hub_surface: object
    tip_surface: object
    sections: int = 6
    along: int = 9
    around: int = 13

    def stream(self, t, s, angle):
        """Points at t on the stream surface s, turned by the angle."""
        r, z = np.moveaxis((1 - s) * self.root(t) + s * self.tip(t), -1, 0)
        return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=-1)

    def beside(self, t, s, forward, across):
        """The point of stream surface s that lies so far forward of and across the blade's middle at t, mm."""
        step = 1e-6
        a, b = (self.stream(t + sign * step, s, np.zeros(()))[[0, 2]] for sign in (-1, 1))
        meridian = np.hypot(*(b - a)) / (2 * step)
        r = self.stream(t, s, np.zeros(()))[0]
        slope = np.array([meridian, r * (self.wrap(t + step, s) - self.wrap(t - step, s)) / (2 * step)])
        slope /= np.hypot(*slope)
        along = forward * slope[0] - across * slope[1]
        round_ = forward * slope[1] + across * slope[0]
        return self.stream(t + along / meridian, s, self.wrap(t, s) + round_ / r)

    def length(self, s):
        """Length of the blade's middle line between the caps, mm."""
        t = np.linspace(*self.caps, 400)
        return float(np.linalg.norm(np.diff(self.stream(t, s, self.wrap(t, s)), axis=0), axis=1).sum())


@dataclass(frozen=True)
class Net:
    """A cubic spline surface by its knots in both directions and its control points (nu, nv, 3)."""

    knots_u: np.ndarray
    knots_v: np.ndarray
    control: np.ndarray

    def at(self, u, v):
        """Points and derivatives in u and v at parameters u (n,) and v (n,)."""
        across = BSpline(self.knots_v, self.control.swapaxes(0, 1), 3)
        lines, rises = across(v), across(v, 1)
        rows = [(line(a), line(a, 1), rise(a)) for a, line, rise in
                ((a, BSpline(self.knots_u, line, 3), BSpline(self.knots_u, rise, 3))
                 for a, line, rise in zip(u, lines, rises, strict=True))]
        return tuple(np.array(part) for part in zip(*rows, strict=True))

    @property
    def nodes(self):
        """Distinct knots in u."""
        return np.unique(self.knots_u)


def side(rotor, sign):
    """Suction (+1) or pressure side (-1), from the leading to the trailing edge."""
    first, last = rotor.caps
    t = np.linspace(first, last, rotor.along)
    s = np.linspace(0, 1, rotor.sections)
    step = 1e-5 * (last - first)

    def points(at):
        return np.array([[rotor.beside(a, b, 0.0, sign * rotor.half(a, b)) for b in s] for a in at])

    def slope(end):
        near = points(end + step * np.array([-1.0, 1.0]))
        return (near[1] - near[0]) / (2 * step) * (last - first)

    return fitted(points(t), s, slope(first), slope(last))


def cap(rotor, end, before, after):
    """A round edge from the end of one side to the beginning of the next, as a circle that touches both.

    end : 0 leading, 1 trailing edge.  before, after : (Net, 0 or 1), a side and which end of it.
    """
    t, out = rotor.caps[end], (1.0 if end else -1.0)
    s = np.linspace(0, 1, rotor.sections)
    step = 1e-5
    share = np.linspace(-1, 1, rotor.around)
    rows, speeds = [], []
    for b in s:
        h = rotor.half(t, b)
        gain = (rotor.half(t + step, b) - rotor.half(t - step, b)) / (2 * step)
        taper = np.arctan(-out * gain * slope_of(rotor, t, b))
        radius, turn = h / np.cos(taper), np.pi / 2 - taper
        angle = -out * share * turn
        forward = out * radius * (np.cos(angle) - np.sin(taper))
        across = radius * np.sin(angle)
        rows.append([rotor.beside(t, b, f, a) for f, a in zip(forward, across, strict=True)])
        speeds.append(2 * turn * radius)
    pts = np.array(rows).swapaxes(0, 1)
    return fitted(pts, s, *(directed(net, place, speeds) for net, place in (before, after)))


def slope_of(rotor, t, s):
    """Value of t gained per mm along the blade's middle."""
    step = 1e-6
    a, b = (rotor.stream(t + k * step, s, rotor.wrap(t + k * step, s)) for k in (-1, 1))
    return 2 * step / float(np.linalg.norm(b - a))


def directed(net, place, speeds):
    """Derivatives of a cap at its end: along the neighbouring side, of the cap's own speed."""
    sections = np.linspace(0, 1, len(speeds))
    ends = BSpline(net.knots_v, (net.control[-1] - net.control[-2]) if place else (net.control[1] - net.control[0]), 3)
    along = ends(sections)
    return along / np.linalg.norm(along, axis=1)[:, None] * np.array(speeds)[:, None]


def fitted(points, s, start, stop):
    """The cubic net through points (nu, nv, 3), evenly spread in u, with given derivatives at both ends of u."""
    u = np.linspace(0, 1, len(points))
    along = make_interp_spline(u, points, k=3, axis=0, bc_type=([(1, start)], [(1, stop)]))
    across = make_interp_spline(s, along.c.swapaxes(0, 1), k=3, axis=0)
    return Net(along.t, across.t, across.c.swapaxes(0, 1))


def unit(v):
    """Rows of length one."""
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def up(rotor, points):
    """Direction in which the height above the hub grows."""
    step = 1e-5
    return unit(np.stack([rotor.above(points + step * e) - rotor.above(points - step * e) for e in np.eye(3)], axis=1))


def contact(rotor, net, u, outward):
    """Where the fillet's ball touches a blade face: v at every u, and the ball's centres."""
    v, step = np.full(len(u), 0.02), 1e-7

    def off(v):
        p, along, rise = net.at(u, v)
        centre = p + rotor.fillet * outward * unit(np.cross(along, rise))
        return rotor.above(centre) - rotor.fillet, centre

    for _ in range(30):
        height, centre = off(v)
        if np.abs(height).max() < 1e-11:
            break
        v = v - height * step / (off(v + step)[0] - height)
    if v.min() < 0:
        raise ValueError(f"the fillet would begin {-v.min():.4f} of the span below the root: lower the root")
    return v, centre


def shortened(rotor, net, outward):
    """The blade face above its fillet."""
    share = np.linspace(0, 1, rotor.sections)
    step = 1e-5
    near = np.array([0.0, step, 1 - step, 1.0])
    v = contact(rotor, net, near, outward)[0]
    ends = []
    for u, low, slope in ((0.0, v[0], (v[1] - v[0]) / step), (1.0, v[3], (v[3] - v[2]) / step)):
        _, along, rise = net.at(np.full(len(share), u), low + (1 - low) * share)
        ends.append(along + rise * (slope * (1 - share))[:, None])
    low = contact(rotor, net, net.nodes, outward)[0]
    points = np.array([net.at(net.nodes, low + (1 - low) * b)[0] for b in share]).swapaxes(0, 1)
    return fitted(points, share, *ends)


def arcs(rotor, net, u, outward):
    """Control rows (n, 4, 3) of the ball's arcs, from the blade to the hub."""
    v, centre = contact(rotor, net, u, outward)
    p = net.at(u, v)[0]
    n, away = unit(centre - p), up(rotor, centre)
    q = centre - rotor.fillet * away
    cosine = (n * away).sum(axis=1, keepdims=True)
    reach = 4 / 3 * np.tan(np.arccos(cosine) / 4) * rotor.fillet
    return np.stack([p, p + reach * unit(cosine * n - away), q + reach * unit(cosine * away - n), q], axis=1)


def fillet(rotor, net, upper, outward):
    """The fillet below a blade face."""
    step = 1e-5
    near = arcs(rotor, net, np.array([0.0, step, 1 - step, 1.0]), outward)
    spline = make_interp_spline(net.nodes, arcs(rotor, net, net.nodes, outward), k=3, axis=0,
                                bc_type=([(1, (near[1] - near[0]) / step)], [(1, (near[3] - near[2]) / step)]))
    control = spline.c.copy()
    control[:, 0] = upper.control[:, 0]
    return Net(upper.knots_u, np.repeat([0.0, 1.0], 4), control)


def ring_of(rotor):
    """Four faces around a blade above its fillets, from the suction side over the trailing edge; and the fillets."""
    suction, pressure = side(rotor, 1), side(rotor, -1)
    back = Net(1 - pressure.knots_u[::-1], pressure.knots_v, pressure.control[::-1])
    trailing = cap(rotor, 1, (suction, 1), (back, 0))
    leading = cap(rotor, 0, (back, 1), (suction, 0))
    middle = np.array([0.5]), np.array([0.5])
    (p,), (along,), (rise,) = suction.at(*middle)
    outward = np.sign(np.cross(along, rise) @ (p - back.at(*middle)[0][0]))
    whole = [suction, trailing, back, leading]
    upper = closed([shortened(rotor, net, outward) for net in whole])
    return upper, closed([fillet(rotor, *nets, outward) for nets in zip(whole, upper, strict=True)])


def closed(ring):
    """Nets that follow each other, with one and the same border between neighbours."""
    middle = [(net.control[-1] + ring[(k + 1) % len(ring)].control[0]) / 2 for k, net in enumerate(ring)]
    return [Net(net.knots_u, net.knots_v, np.concatenate([middle[k - 1][None], net.control[1:-1], middle[k][None]]))
            for k, net in enumerate(ring)]


def counted(knots):
    """Knots and multiplicities as the kernel takes them."""
    values, repeats = np.unique(knots, return_counts=True)
    places, counts = RealArray(1, len(values)), IntegerArray(1, len(values))
    for k, (value, repeat) in enumerate(zip(values, repeats, strict=True)):
        places.SetValue(k + 1, float(value))
        counts.SetValue(k + 1, int(repeat))
    return places, counts


def kernel_face(net):
    """A face over the whole of a net."""
    nu, nv, _ = net.control.shape
    poles = PointGrid(1, nu, 1, nv)
    for i in range(nu):
        for j in range(nv):
            poles.SetValue(i + 1, j + 1, gp_Pnt(*map(float, net.control[i, j])))
    (ku, mu), (kv, mv) = counted(net.knots_u), counted(net.knots_v)
    return BRepBuilderAPI_MakeFace(Geom_BSplineSurface(poles, ku, kv, mu, mv, 3, 3), 1e-7).Face()


def kernel_edge(knots, control):
    """An edge along a cubic spline."""
    poles = PointArray(1, len(control))
    for k, point in enumerate(control):
        poles.SetValue(k + 1, gp_Pnt(*map(float, point)))
    return BRepBuilderAPI_MakeEdge(Geom_BSplineCurve(poles, *counted(knots), 3)).Edge()


def arc(radius, z, start, stop):
    """An edge along a circle about the axis, counter-clockwise seen from above."""
    return BRepBuilderAPI_MakeEdge(gp_Circ(gp_Ax2(gp_Pnt(0, 0, z), gp_Dir(0, 0, 1), gp_Dir(1, 0, 0)), radius),
                                   float(start), float(stop)).Edge()


def wire(*edges):
    """One wire of edges that follow each other."""
    making = BRepBuilderAPI_MakeWire()
    for edge in edges:
        making.Add(edge)
    return making.Wire()


def bounded(surface, outer, inner=None):
    """The smaller of the two faces of a surface that a wire divides, less what another wire cuts out."""
    faces = []
    for way in (outer, as_wire(outer.Reversed())):
        making = BRepBuilderAPI_MakeFace(surface, way, True)
        if inner is not None:
            making.Add(inner)
        fixing = ShapeFix_Face(making.Face())
        fixing.SetPrecision(1e-7)
        fixing.Perform()
        size = GProp_GProps()
        BRepGProp.SurfaceProperties_s(fixing.Face(), size)
        faces.append((size.Mass(), len(faces), fixing.Face()))
    return min(found for found in faces if found[0] > 0)[2]


def border(rotor, t):
    """Angle of the line on the hub half-way between a blade and the next."""
    return rotor.wrap(t, np.zeros(())) + np.pi / rotor.blades


def hub_face(rotor, below):
    """The hub around one blade, its borders slanting as the blade does."""
    pitch = 2 * np.pi / rotor.blades
    t = np.linspace(*rotor.hub_ends, 25)
    angle = border(rotor, t)
    slant = make_interp_spline(np.linspace(0, 1, 25), rotor.hub(t, angle), k=3)
    turned = slant.c @ np.array([[np.cos(pitch), -np.sin(pitch), 0], [np.sin(pitch), np.cos(pitch), 0], [0, 0, 1]])
    (x0, y0, z0), (x1, y1, z1) = slant(0.0), slant(1.0)
    outer = wire(arc(np.hypot(x0, y0), z0, angle[0] - pitch, angle[0]), kernel_edge(slant.t, slant.c),
                 arc(np.hypot(x1, y1), z1, angle[-1] - pitch, angle[-1]), kernel_edge(slant.t, turned))
    hole = wire(*(kernel_edge(net.knots_u, net.control[:, 3]) for net in below))
    return bounded(rotor.hub_surface, outer, hole)


def sector(rotor, around=()):
    """Faces of one blade: hub around it, four sides, four fillets, tip; and what else is made by sector."""
    upper, below = ring_of(rotor)
    top = wire(*(kernel_edge(net.knots_u, net.control[:, -1]) for net in upper))
    return [hub_face(rotor, below), *map(kernel_face, upper), *map(kernel_face, below), bounded(rotor.tip_surface, top),
            *around]


def rim(rotor, end, z):
    """The cylinder from one end of a sector's hub to a height z."""
    pitch, t = 2 * np.pi / rotor.blades, rotor.hub_ends[end]
    x, y, start = map(float, rotor.hub(t, border(rotor, t) - pitch))
    line = BRepBuilderAPI_MakeEdge(gp_Pnt(x, y, start), gp_Pnt(x, y, z)).Edge()
    return BRepPrimAPI_MakeRevol(line, AXIS, pitch).Shape()


def ring_plane(rotor, radius, end, z, bore):
    """The plane between the bore and a circle that is divided as the hub is."""
    pitch, angle = 2 * np.pi / rotor.blades, border(rotor, rotor.hub_ends[end])
    outer = wire(*(arc(radius, z, angle + (k - 1) * pitch, angle + k * pitch) for k in range(rotor.blades)))
    inner = wire(arc(bore, z, 0, 2 * np.pi))
    return bounded(Geom_Plane(gp_Pnt(0, 0, z), gp_Dir(0, 0, 1)), outer, inner)


def bore(radius, low, high):
    """The cylinder of the bore."""
    line = BRepBuilderAPI_MakeEdge(gp_Pnt(radius, 0, low), gp_Pnt(radius, 0, high)).Edge()
    return BRepPrimAPI_MakeRevol(line, AXIS).Shape()


def solid(rotor, faces, others):
    """The sector turned to every blade and closed with the other faces, as one solid."""
    sewing = BRepBuilderAPI_Sewing(1e-4)
    for k in range(rotor.blades):
        turn = gp_Trsf()
        turn.SetRotation(AXIS, 2 * np.pi * k / rotor.blades)
        for face in faces:
            sewing.Add(BRepBuilderAPI_Transform(face, turn, True).Shape() if k else face)
    for face in others:
        sewing.Add(face)
    sewing.Perform()
    if sewing.NbFreeEdges():
        raise ValueError(f"{sewing.NbFreeEdges()} edges have one face only: the shell is open")
    body = BRepBuilderAPI_MakeSolid(as_shell(sewing.SewedShape())).Solid()
    BRepLib.OrientClosedSolid_s(body)
    return body


def least_gap(rotor, count=60):
    """Least distance between one blade and the next, fillets apart, and the two points, mm."""
    ring, _ = ring_of(rotor)
    pitch = 2 * np.pi / rotor.blades
    turn = np.array([[np.cos(pitch), np.sin(pitch), 0], [-np.sin(pitch), np.cos(pitch), 0], [0, 0, 1]])
    whole = np.array([[0.0, 1.0], [0.0, 1.0]])
    best = (np.inf, None, None)
    for one in ring:
        for other in ring:
            windows, found, size = (whole, whole), best, 1.0
            while size > 1e-7:
                sides = [over(net, window, count if size == 1.0 else 16)
                         for net, window in zip((one, other), windows, strict=True)]
                away, index = cKDTree(sides[0][0]).query(sides[1][0] @ turn)
                k = int(away.argmin())
                if size == 1.0 and away[k] > best[0] + 1:
                    break
                places = sides[0][1][index[k]], sides[1][1][k]
                found = (float(away[k]), sides[0][0][index[k]], sides[1][0][k] @ turn)
                size *= 0.04 if size == 1.0 else 0.4
                windows = tuple(np.clip(np.stack([at - size, at + size], axis=1), 0, 1) for at in places)
            best = min(best, found, key=lambda item: item[0])
    return best


def over(net, window, count):
    """Points of a net on a grid over a window of its parameters, (n, 3), and the parameters, (n, 2)."""
    u, v = (np.linspace(*limits, count) for limits in window)
    lines = BSpline(net.knots_v, net.control.swapaxes(0, 1), 3)(v)
    points = BSpline(net.knots_u, lines.swapaxes(0, 1), 3)(u)
    return points.reshape(-1, 3), np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2)
