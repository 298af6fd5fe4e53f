"""Tool orientations for multi-axis machining of sculptured surfaces.

The public names resolve when they are first used (PEP 562), so that importing the package costs next to nothing.
"""

import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from toolaxis.batch.run import batch as batch
    from toolaxis.cad.load import load as load
    from toolaxis.cad.machines import load_machine as load_machine
    from toolaxis.contact.clearance.clearance import clearance as clearance
    from toolaxis.contact.clearance.gouge import gouge as gouge
    from toolaxis.contact.drop_cutter.drop_cutter import drop_cutter as drop_cutter
    from toolaxis.contact.placement import place as place
    from toolaxis.contact.strip.width import strip_width as strip_width
    from toolaxis.errors import Cancelled as Cancelled
    from toolaxis.errors import InvalidInput as InvalidInput
    from toolaxis.errors import JobError as JobError
    from toolaxis.errors import MissingBackend as MissingBackend
    from toolaxis.errors import ToolAxisError as ToolAxisError
    from toolaxis.errors import UnsupportedGeometry as UnsupportedGeometry
    from toolaxis.job.files.read_cl import read_cl as read_cl
    from toolaxis.job.inputs.tool_library import load_tools as load_tools
    from toolaxis.job.output.export import export as export
    from toolaxis.job.output.export import to_trimesh as to_trimesh
    from toolaxis.job.output.verify import verify as verify
    from toolaxis.job.planning.pipeline import plan as plan
    from toolaxis.machine.setup import Mounting as Mounting
    from toolaxis.partition.partition import partition as partition
    from toolaxis.path.estimate import estimate as estimate
    from toolaxis.path.iso_parametric import passes as passes
    from toolaxis.path.pass_count import count as count
    from toolaxis.path.sampling import sample_points as sample_points
    from toolaxis.plan.sub_surface import SubSurface as SubSurface
    from toolaxis.search.fixed_axis import best_axis as best_axis
    from toolaxis.shape.face import Face as Face
    from toolaxis.shape.part import Part as Part
    from toolaxis.skin.join import join as join
    from toolaxis.tolerances import Tolerance as Tolerance
    from toolaxis.tools.tool import Tool as Tool

__version__ = "0.1.0"

_HOME = {
    "Tool": "tools.tool", "Face": "shape.face", "Part": "shape.part", "Tolerance": "tolerances", "load": "cad.load",
    "place": "contact.placement", "strip_width": "contact.strip.width", "gouge": "contact.clearance.gouge",
    "clearance": "contact.clearance.clearance", "drop_cutter": "contact.drop_cutter.drop_cutter",
    "sample_points": "path.sampling", "estimate": "path.estimate", "count": "path.pass_count",
    "passes": "path.iso_parametric", "best_axis": "search.fixed_axis", "partition": "partition.partition",
    "plan": "job.planning.pipeline", "verify": "job.output.verify", "ToolAxisError": "errors", "InvalidInput": "errors",
    "UnsupportedGeometry": "errors", "MissingBackend": "errors", "JobError": "errors", "Cancelled": "errors",
    "load_machine": "cad.machines", "load_tools": "job.inputs.tool_library", "Mounting": "machine.setup",
    "join": "skin.join",
    "batch": "batch.run", "read_cl": "job.files.read_cl", "SubSurface": "plan.sub_surface",
    "export": "job.output.export", "to_trimesh": "job.output.export",
}

__all__ = sorted([*_HOME, "__version__"])  # noqa: PLE0605


def _resolve(name: str) -> Any:
    return getattr(import_module(f"toolaxis.{_HOME[name]}"), name)


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'toolaxis' has no attribute {name!r}")
    value = globals()[name] = _resolve(name)
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *_HOME})


class _Package(ModuleType):
    """The package as an object: `batch`, `partition`, `plan` and `verify` stay the public functions.

    Subpackages have the same names, and the import system would put them in the functions' place.
    """

    batch = property(lambda self: _resolve("batch"), lambda self, subpackage: None)
    partition = property(lambda self: _resolve("partition"), lambda self, subpackage: None)
    plan = property(lambda self: _resolve("plan"), lambda self, subpackage: None)
    verify = property(lambda self: _resolve("verify"), lambda self, subpackage: None)


sys.modules[__name__].__class__ = _Package
