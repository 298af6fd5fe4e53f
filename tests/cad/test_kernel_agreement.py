"""The contract of the adapters for Open CASCADE: every face of real parts, evaluated by us and by the kernel."""

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

from toolaxis.cad.ocp.kernel_names import as_face
from toolaxis.cad.ocp.reader import face_map

EVERYTHING = pytest.mark.parametrize("everything", [False, pytest.param(True, marks=pytest.mark.long)])


def xyz(p):
    return np.array([p.X(), p.Y(), p.Z()])


class OcpFace:
    """A face of the kernel as the contract asks it."""

    def __init__(self, face):
        self.face = face
        self.flip = face.Orientation().name == "TopAbs_REVERSED"
        self.tolerance = BRep_Tool.Tolerance_s(face)
        self.adaptor = BRepAdaptor_Surface(face)

    def first(self, u, v):
        p, du, dv = gp_Pnt(), gp_Vec(), gp_Vec()
        self.adaptor.D1(u, v, p, du, dv)
        return xyz(p), xyz(du), xyz(dv)

    def second(self, u, v):
        p, vectors = gp_Pnt(), [gp_Vec() for _ in range(5)]
        self.adaptor.D2(u, v, p, *vectors)
        return tuple(map(xyz, vectors[2:]))

    def bend(self, u, v):
        properties = BRepLProp_SLProps(self.adaptor, u, v, 2, 1e-15)
        if not (properties.IsNormalDefined() and properties.IsCurvatureDefined()):
            return None
        d1, d2 = gp_Dir(), gp_Dir()
        if properties.IsUmbilic():
            return properties.MaxCurvature(), properties.MinCurvature(), None, None
        properties.CurvatureDirections(d1, d2)
        return properties.MaxCurvature(), properties.MinCurvature(), xyz(d1), xyz(d2)

    def inside(self, u, v):
        state = BRepClass_FaceClassifier(self.face, gp_Pnt2d(u, v), 1e-9).State()
        return {TopAbs_State.TopAbs_IN: True, TopAbs_State.TopAbs_OUT: False}.get(state)


class OcpShape:
    """A shape of the kernel as the contract asks it."""

    accuracy = 1e-4

    def __init__(self, shape):
        faces = face_map(shape)
        self.faces = {n: OcpFace(as_face(faces.FindKey(n))) for n in range(1, faces.Extent() + 1)}
        self.explorer = TopExp_Explorer(shape, TopAbs_SOLID)
        self.properties = GProp_GProps()
        if self.explorer.More():
            self.solid = self.explorer.Current()

    @property
    def volume(self):
        if not self.explorer.More():
            return None
        BRepGProp.VolumeProperties_s(self.solid, self.properties, 1e-6, False, False)
        return self.properties.Mass()

    @property
    def centre(self):
        return xyz(self.properties.CentreOfMass())


@pytest.fixture(scope="module")
def asked(kernel_shape):
    return OcpShape(kernel_shape)


@EVERYTHING
def test_points_normals_and_curvatures_agree_with_the_kernel(contract, asked, kernel_record, everything):
    contract.check_values(asked, kernel_record, everything)


@EVERYTHING
def test_derivatives_agree_with_the_kernel_where_parameters_are_the_same(contract, asked, kernel_record, everything):
    contract.check_derivatives(asked, kernel_record, everything)


def test_loops_stay_inside_the_domain_of_their_surface(contract, kernel_record):
    contract.check_loops(kernel_record)


@EVERYTHING
def test_inside_and_outside_agree_with_the_kernel_away_from_borders(contract, asked, kernel_record, everything):
    contract.check_inside(asked, kernel_record, everything)


@EVERYTHING
def test_faces_enclose_the_volume_that_the_kernel_says(contract, asked, kernel_record, everything):
    contract.check_volume(asked, kernel_record, everything)
