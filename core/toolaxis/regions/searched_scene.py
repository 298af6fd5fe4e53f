"""The surroundings of a face as the search for its axis sees them."""

from dataclasses import replace

from toolaxis.feasibility.surroundings import MARGIN, SKIN
from toolaxis.regions.scene import ReachScene
from toolaxis.search.face_problem import FaceProblem

#: How much deeper the cutter may gouge than the search allows, mm: the search counts what its bounds may be off, too.
_SLACK = 0.001


def tighten_scene(job: FaceProblem, scene: ReachScene) -> ReachScene:
    """A scene with the distances that the search for an axis keeps, which are a little larger, and with its limits.

    Parameters
    ----------
    job : FaceProblem
        What decides about the axis.
    scene : ReachScene
        Of the part that the face belongs to.
    """
    own = job.feasibility
    given, skin = own.tolerance, next((one for one in own.groups if one.role == SKIN), None)
    gouge = given.gouge if skin is None else own.allowance - float(skin.required[0]) + _SLACK
    kept = replace(given, gouge=gouge, cutter_clearance=given.cutter_clearance + MARGIN,
                   shank_clearance=given.shank_clearance + MARGIN, holder_clearance=given.holder_clearance + MARGIN)
    return replace(scene, tolerance=kept, limits=own.limits, allowance=own.allowance)
