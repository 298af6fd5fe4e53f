"""Which view provider each kind of object gets."""

from freecad.toolaxis.document.machine import MachineProxy
from freecad.toolaxis.document.operation import OperationProxy
from freecad.toolaxis.document.plan_group import WholePlan
from freecad.toolaxis.document.tool_on_path import ToolOnPasses
from freecad.toolaxis.gui.views.machine import MachineView
from freecad.toolaxis.gui.views.operation import OperationView
from freecad.toolaxis.gui.views.plan_group import WholePlanView
from freecad.toolaxis.gui.views.tool_on_path import ToolView

VIEWS = {MachineProxy.Type: MachineView, OperationProxy.Type: OperationView, WholePlan.Type: WholePlanView,
         ToolOnPasses.Type: ToolView}


def attach(thing):
    """Give an object its view provider.

    Parameters
    ----------
    thing : App.DocumentObject
        With its proxy.
    """
    VIEWS[thing.Proxy.Type](thing.ViewObject)
