"""Names in documents and macros of earlier versions, and the modules of today that they stand for.

With each of our objects FreeCAD saves the module and the class of its proxy and of its view provider, and imports them
by these names when the document is opened.  What stands here opens for ever; saved again, a document has today's names.
"""

from functools import partial
from importlib import import_module
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec

#: Modules in this add-on, by their former names.
TODAY = {
    "objects.machine": "document.machine",
    "objects.operation": "document.operation",
    "objects.tool": "document.tool_on_path",
    "objects.wholeplan": "document.plan_group",
    "views.machine": "gui.views.machine",
    "views.operation": "gui.views.operation",
    "views.tool": "gui.views.tool_on_path",
    "views.wholeplan": "gui.views.plan_group",
    # Not in documents: the panel that exports wrote it into macros.
    "exporting": "services.export",
}
#: Classes in these modules, by their former names.
CLASSES = {"Machine": "MachineProxy", "Operation": "OperationProxy"}
#: Packages that the former names stand in.
FORMER_PACKAGES = {name.rpartition(".")[0] for name in TODAY} - {""}


class FormerModules(MetaPathFinder, Loader):
    """Finds a module of today where a former one is imported."""

    def find_spec(self, fullname, path=None, target=None):
        """A module of which `exec_module` makes a stand-in; None for all other names.

        Parameters
        ----------
        fullname : str
        path, target : optional
            Not looked at.
        """
        name = _within(fullname)
        if name not in TODAY and name not in FORMER_PACKAGES:
            return None
        return ModuleSpec(fullname, self, is_package=name in FORMER_PACKAGES)

    def exec_module(self, module):
        """Let a former module answer with what today's has.

        Parameters
        ----------
        module : module
            New and empty.
        """
        name = _within(module.__name__)
        if name in TODAY:
            module.__getattr__ = partial(_look_up, import_module(f"{__package__}.{TODAY[name]}"))


def _look_up(module, name):
    """What a module of today has by a name, or by the one that stands for a former class."""
    return getattr(module, name) if hasattr(module, name) else getattr(module, CLASSES.get(name, name))


def _within(fullname):
    """The name of a module within the add-on; empty for all other modules."""
    prefix = f"{__package__}."
    return fullname.removeprefix(prefix) if fullname.startswith(prefix) else ""
