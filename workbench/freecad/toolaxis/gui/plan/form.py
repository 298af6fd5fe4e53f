"""The fields of the planning panel: what they hold, and in one sentence why that is not possible."""

from contextlib import suppress
from math import degrees

import FreeCAD
from freecad.toolaxis.document.inputs import JobInputs, flute_of
from freecad.toolaxis.document.machine_limits import PREFIX, mounting
from freecad.toolaxis.document.strategies import INDEXED, STRATEGIES, keeps_roughness, needs, titles
from freecad.toolaxis.gui.plan.earlier_choice import EarlierChoice
from freecad.toolaxis.gui.plan.face_list import BodyList, FaceList
from freecad.toolaxis.gui.plan.rack_choice import RackChoice
from freecad.toolaxis.gui.plan.setup_tab import SetupTab
from freecad.toolaxis.gui.plan.shown_inputs import inputs_to_show
from freecad.toolaxis.gui.widgets.fields import OutlineTable
from freecad.toolaxis.gui.widgets.quantity import QuantityField
from freecad.toolaxis.services.background import one_line, sentence
from PySide import QtWidgets

from toolaxis.plan.choices import DIRECTIONS, ISO, PASSES
from toolaxis.tools.registry import cutters

translate = FreeCAD.Qt.translate

KINDS = tuple(cutters())
#: The field of each size of a cutter.
_FIELDS = {"diameter": "diameter", "corner_radius": "corner", "half_angle_deg": "taper"}
OBJECTIVES = ("length", "passes")
METHODS = ("sphere", "sectors", "jerk", "roman", "normal", "one", "ball")
#: Fields of the tab Advanced, and what they hold.
_ASKED = {"stock": "stock", "greatestStepOver": "greatest_step_over", "lead": "lead", "leastLean": "least_lean"}
_LINES = {"allowanceOn": "allowance_on", "avoidFaces": "avoid_faces", "held": "held"}
_NONE, _AUTO, _NUMBER = range(3)
_NO_LIMITS, _CONE, _ROTARY = range(3)


class PlanForm:
    """Reads and fills the fields of plan.ui.

    Parameters
    ----------
    form : QWidget
    """

    def __init__(self, form):
        self.form = form
        self.faces = FaceList(self._find("faces", QtWidgets.QListWidget))
        self.avoid = BodyList(self._find("avoid", QtWidgets.QListWidget))
        self.shank, self.holder = OutlineTable(form, "shank"), OutlineTable(form, "holder")
        lengths = ("diameter", "corner", "fluteLength", "stickout")
        angles = ("taper", "cone", "tiltLow", "tiltHigh", "turnLow", "turnHigh")
        self.quantities = {name: QuantityField(self._find(name)) for name in lengths}
        self.quantities |= {name: QuantityField(self._find(name), "deg", (0, 4)) for name in angles}
        self.quantities |= {name: QuantityField(self._find(name), decimals=(2, 5), step=0.005)
                            for name in ("scallop", "tolerance", "allowance")}
        self.quantities |= {name: QuantityField(self._find(name), decimals=(2, 4), step=0.1)
                            for name in ("stock", "greatestStepOver", "lead")}
        self.quantities["leastLean"] = QuantityField(self._find("leastLean"), "deg", (0, 4))
        self.lines = {field: self._find(field, QtWidgets.QLineEdit) for field in _LINES}
        self.racks, self._several = RackChoice(form), False
        self.setup = SetupTab(form, self.faces)
        self.earlier = EarlierChoice(form, self.faces)
        self.quantities["feedrate"] = QuantityField(self._find("feedrate"), "mm/min", (0, 2), 100.0)
        self.kind, self.tool = self._find("kind", QtWidgets.QComboBox), self._find("tool", QtWidgets.QComboBox)
        self.kind.addItems([translate("ToolAxisPlan", one.title) for one in cutters().values()])
        self.limits = self._find("limits", QtWidgets.QComboBox)
        self.spindle = self._find("spindle", QtWidgets.QSpinBox)
        self.middle = [self._find(name, QtWidgets.QDoubleSpinBox) for name in ("limitX", "limitY", "limitZ")]
        self.counts = {name: (self._find(name, QtWidgets.QComboBox), self._find(f"{name}Number", QtWidgets.QSpinBox))
                       for name in ("regions", "orientations")}
        self.strategy = self._find("strategy", QtWidgets.QComboBox)
        self.strategy.addItems(titles())
        self.roughness = self._find("roughness", QtWidgets.QDoubleSpinBox)
        self.switches = {name: self._find(name, QtWidgets.QCheckBox) for name in ("blades", "compare")}
        self.unshown, self.given, self.reason = "", ("", 0, ""), ""
        self.racks.on_change(self._show_what_counts)
        for combo, _ in self.counts.values():
            combo.currentIndexChanged.connect(self._show_what_counts)
        self.kind.currentIndexChanged.connect(self._show_what_counts)
        self.limits.currentIndexChanged.connect(self._show_what_counts)
        self.strategy.currentIndexChanged.connect(self._show_what_counts)
        self._show_what_counts()

    def _find(self, name, kind=QtWidgets.QWidget):
        found = self.form.findChild(kind, name)
        assert found is not None, name
        return found

    def on_change(self, slot):
        """Call a slot without arguments whenever a field changes.

        Parameters
        ----------
        slot : callable
        """
        for field in self.quantities.values():
            field.on_change(slot)
        for table in (self.shank, self.holder):
            table.on_change(slot)
        for name in ("kind", "limits", "objective", "direction", "passes", "method", "strategy", *self.counts):
            self._find(name, QtWidgets.QComboBox).currentIndexChanged.connect(lambda _: slot())
        for box in self.switches.values():
            box.toggled.connect(lambda _: slot())
        for spin in (*self.middle, self.spindle, self.roughness, *(spin for _, spin in self.counts.values())):
            spin.valueChanged.connect(lambda _: slot())
        for line in self.lines.values():
            line.textChanged.connect(lambda _: slot())
        self.racks.on_change(slot)
        self.earlier.on_change(slot)
        self.avoid.widget.itemChanged.connect(lambda _: slot())
        self.faces.on_change(slot)

    def _show_what_counts(self, *_):
        sizes, limits = cutters()[KINDS[self.kind.currentIndex()]].sizes, self.limits.currentIndex()
        shown = {"corner": "corner_radius" in sizes, "taper": "half_angle_deg" in sizes, "cone": limits == _CONE,
                 "limitX": limits != _NO_LIMITS and limits < 3, "tiltLow": limits == _ROTARY,
                 "turnLow": limits == _ROTARY, "roughness": keeps_roughness(self.strategy_name)}
        members = {"limitX": ("limitX", "limitY", "limitZ"), "tiltLow": ("tiltLow", "tiltHigh"),
                   "turnLow": ("turnLow", "turnHigh")}
        for combo, spin in self.counts.values():
            spin.setVisible(combo.currentIndex() == _NUMBER)
        self._find("strategyNote").setText(needs(self.strategy_name))
        several = bool(self.racks.chosen)
        for name in ("method", "passes", "blades"):
            self._find(name).setEnabled(self.strategy_name == INDEXED)
        for name in ("orientations", "orientationsNumber"):
            self._find(name).setEnabled(self.strategy_name == INDEXED and not several)
        for name in ("strategy", "compare"):
            self._find(name).setEnabled(not several)
        self._show_division(several)
        for name in ("toolGroup", "holderGroup", "shankGroup"):
            self._find(name).setVisible(not several)
        for name, visible in shown.items():
            for member in (*members.get(name, (name,)), f"{name}Label"):
                self._find(member).setVisible(visible)

    def _show_division(self, several):
        """Show what a rack does with faces unless it is told otherwise, and what one tool does, as soon as the other is
        chosen."""
        if several != self._several:
            self._several = several
            self.set_count("regions", None)

    @property
    def strategy_name(self):
        """The strategy that is chosen, by its name in `STRATEGIES`; a rack is planned with fixed axes."""
        return INDEXED if self.racks.chosen else STRATEGIES[max(self.strategy.currentIndex(), 0)]

    def set_tool(self, text):
        """Show the sizes of a cutter.

        Parameters
        ----------
        text : str
            Its short form, "torus:12x1".
        """
        kind, _, sizes = text.strip().lower().partition(":")
        numbers = [float(size) for size in sizes.split("x")]
        self.kind.setCurrentIndex(KINDS.index(kind))
        for size, value in zip(cutters()[kind].sizes, numbers, strict=True):
            self.quantities[_FIELDS[size]].value = value

    def take_tool(self, tool, speeds):
        """Show a tool of the document or the library: cutter and shank, and what is known of the rest and of speeds.

        Parameters
        ----------
        tool : toolaxis.tools.tool.Tool
        speeds : (float or None, float or None)
            Feed rate, mm/min, and spindle speed, rev/min.
        """
        if speeds[0]:
            self.quantities["feedrate"].value = speeds[0]
        if speeds[1]:
            self.spindle.setValue(int(speeds[1]))
        self.set_tool(tool.name)
        if tool.stickout is not None:
            self.quantities["stickout"].value = tool.stickout
        self.quantities["fluteLength"].value = flute_of(tool)
        self.shank.rows = () if tool.shank is None else tool.shank.tolist()
        if tool.holder is not None:
            self.holder.rows = tool.holder.tolist()

    @property
    def tool_text(self):
        """The cutter's short form."""
        kind = KINDS[self.kind.currentIndex()]
        names = [_FIELDS[size] for size in cutters()[kind].sizes]
        return f"{kind}:" + "x".join(f"{self.quantities[name].value:.12g}" for name in names)

    @property
    def limits_text(self):
        """The axis limits in their short form; empty for none."""
        choice = self.limits.currentIndex()
        x, y, z = (f"{spin.value():.12g}" for spin in self.middle)
        values = {name: f"{field.value:.12g}" for name, field in self.quantities.items()}
        if choice == _CONE:
            return f"cone:{x},{y},{z},{values['cone']}"
        if choice == _ROTARY:
            return (f"rotary:tilt={values['tiltLow']}..{values['tiltHigh']},turn={values['turnLow']}.."
                    f"{values['turnHigh']},z={x}/{y}/{z}" + self._turn_zero())
        return (self.limits.currentData() or "") if choice > _ROTARY else ""

    def offer_machines(self, machines):
        """Offer machines as limits of the axis.

        Parameters
        ----------
        machines : list of (str, str)
            What is shown, and the text that stands for it.
        """
        for shown, text in machines:
            self.limits.addItem(shown, text)

    def _turn_zero(self):
        """Where turn 0 points, when the middle lies along x and the usual +x has no direction across it."""
        x, y, z = (spin.value() for spin in self.middle)
        return ",x=0/1/0" if abs(y) + abs(z) < 1e-6 * abs(x) else ""

    def set_limits(self, text):
        """Show axis limits; a form that the fields cannot hold stays as a choice of its own.

        Parameters
        ----------
        text : str
            Short form, or empty.
        """
        from toolaxis.errors import ToolAxisError
        from toolaxis.machine.limits import Cone, RotaryRanges, parse_limits

        defaults = {"cone": 60.0, "tiltLow": 0.0, "tiltHigh": 90.0, "turnLow": -180.0, "turnHigh": 180.0}
        found = None
        if text and not text.startswith(PREFIX):
            with suppress(ToolAxisError):  # it is refused with the reason, as what is chosen
                found = parse_limits(text)
        middle, choice = (0.0, 0.0, 1.0), _NO_LIMITS
        if isinstance(found, Cone):
            middle, choice, defaults["cone"] = found.direction, _CONE, degrees(found.tilt)
        elif isinstance(found, RotaryRanges):
            middle, choice = found.z, _ROTARY
            for name in ("tilt", "turn"):
                defaults[f"{name}Low"], defaults[f"{name}High"] = (degrees(v) for v in getattr(found, name))
        elif text:
            choice = self.limits.findData(text)
            if choice < 0:
                choice = self.limits.count()
                self.limits.addItem(text, text)
        for spin, value in zip(self.middle, middle, strict=True):
            spin.setValue(value)
        for name, value in defaults.items():
            self.quantities[name].value = value
        self.limits.setCurrentIndex(choice)

    def count(self, name):
        """A number of sub-surfaces or axes: a whole number, "auto" or None.

        Parameters
        ----------
        name : str
            "regions" or "orientations".
        """
        combo, spin = self.counts[name]
        if name == "orientations" and (self.racks.chosen or self.strategy_name != INDEXED):
            return None
        usual = {_NONE: 1, _AUTO: None} if self.racks.chosen else {_NONE: None, _AUTO: "auto"}
        return usual.get(combo.currentIndex(), spin.value())

    def set_count(self, name, count):
        """Show a number of sub-surfaces or axes.

        Parameters
        ----------
        name : str
        count : int, "auto" or None
        """
        combo, spin = self.counts[name]
        if isinstance(count, int):
            spin.setValue(count)
        usual = {1: _NONE, None: _AUTO, "auto": _AUTO} if self.racks.chosen else {None: _NONE, "auto": _AUTO}
        combo.setCurrentIndex(usual.get(count, _NUMBER))

    def fill(self, inputs):
        """Show what a job was, or should be, given; what no field can show is a refusal until a field is changed.

        Parameters
        ----------
        inputs : freecad.toolaxis.document.inputs.JobInputs
        """
        self.unshown, inputs = inputs_to_show(inputs, self.spindle.maximum())
        self.faces.faces = inputs.faces
        self.earlier.choose(inputs.after)
        self.quantities["corner"].value, self.quantities["taper"].value = 1.0, 5.0
        self.set_tool(inputs.tool)
        self.shank.rows, self.holder.rows = inputs.shank or (), inputs.holder or ()
        for name in ("stickout", "scallop", "tolerance", "allowance", "feedrate"):
            self.quantities[name].value = getattr(inputs, name) or 0.0
        self.quantities["fluteLength"].value = inputs.flute_length
        self.spindle.setValue(int(inputs.spindle))
        self._find("objective", QtWidgets.QComboBox).setCurrentIndex(OBJECTIVES.index(inputs.objective))
        self._find("direction", QtWidgets.QComboBox).setCurrentIndex(DIRECTIONS.index(inputs.direction))
        self._find("passes", QtWidgets.QComboBox).setCurrentIndex(PASSES.index(inputs.passes))
        self._find("method", QtWidgets.QComboBox).setCurrentIndex(METHODS.index(inputs.method))
        self.strategy.setCurrentIndex(STRATEGIES.index(inputs.strategy))
        self.roughness.setValue(inputs.roughness)
        for name, box in self.switches.items():
            box.setChecked(getattr(inputs, name))
        for field, name in _ASKED.items():
            self.quantities[field].value = getattr(inputs, name)
        for field, name in _LINES.items():
            self.lines[field].setText(getattr(inputs, name))
        self.racks.choose(inputs.rack, inputs.most_tools)
        for name in self.counts:
            self.set_count(name, getattr(inputs, name))
        self.setup.fill(inputs)
        self.given = self.tool_text, inputs.tool_number, inputs.tool_title
        self.set_limits(inputs.limits)

    def read(self):
        """What the fields hold, as keyword arguments of `freecad.toolaxis.document.inputs.JobInputs`.

        Raises
        ------
        ValueError
            With a sentence, where a cell of a table is no length.
        """
        rack = self.racks.chosen
        tool, number, title = self.given
        if rack or tool != self.tool_text:  # another cutter has another name
            number, title = 0, ""
        return {"faces": self.faces.faces, "tool": self.tool_text, "shank": () if rack else self.shank.rows,
                "holder": () if rack else self.holder.rows, "stickout": self.quantities["stickout"].value,
                "rack": rack, "most_tools": self.racks.most, "tool_number": number, "tool_title": title,
                **{name: self.quantities[field].value for field, name in _ASKED.items()},
                **{name: self.lines[field].text().strip() for field, name in _LINES.items()},
                "flute_length": self.quantities["fluteLength"].value,
                **{name: self.quantities[name].value for name in ("scallop", "tolerance", "allowance")},
                "limits": self.limits_text, "obstacles": self.avoid.ticked,
                "origin": self.setup.origin, "stock_box": self.setup.stock_box, "after": self.earlier.chosen,
                "objective": OBJECTIVES[self._find("objective", QtWidgets.QComboBox).currentIndex()],
                "direction": DIRECTIONS[self._find("direction", QtWidgets.QComboBox).currentIndex()],
                "passes": PASSES[self._find("passes", QtWidgets.QComboBox).currentIndex()]
                if self.strategy_name == INDEXED else ISO,
                "feedrate": self.quantities["feedrate"].value, "spindle": float(self.spindle.value()),
                "method": METHODS[self._find("method", QtWidgets.QComboBox).currentIndex()]
                if self.strategy_name == INDEXED else METHODS[0],
                "strategy": self.strategy_name, "roughness": self.roughness.value(),
                **{name: self.count(name) for name in self.counts},
                **{name: box.isChecked() and not (rack and name == "compare")
                   for name, box in self.switches.items()}}

    def refusal(self):
        """Why the fields cannot be computed with, one sentence; empty where they can.

        What the library says against them stays in `reason`, in its own words.
        """
        from toolaxis.errors import ToolAxisError

        self.reason = ""
        if self.unshown:
            return self.unshown
        try:
            check(self.read())
        except (ToolAxisError, ValueError) as reason:
            self.reason = one_line(reason)
            return sentence(reason)
        if not self.faces.faces:
            return translate("ToolAxis", "Select one or more faces in the 3D view and press Add selected")
        return self.setup.refusal


def check(values):
    """Check what a job is given, without its faces.

    Parameters
    ----------
    values : dict
        As `PlanForm.read` gives it.

    Raises
    ------
    InvalidInput
        With quantity, value, rule and remedy.
    """
    from toolaxis.errors import InvalidInput
    from toolaxis.machine.limits import parse_limits

    inputs = JobInputs(**{**values, "obstacles": ()})
    if not inputs.rack and inputs.stickout <= 0:
        raise InvalidInput(f"stick-out is {inputs.stickout:g} mm: it must be above zero")
    inputs.check_tools()
    inputs.check_counts()
    if values["limits"].startswith(PREFIX):
        mounting(values["limits"], inputs.tools()[0])
    elif values["limits"]:
        parse_limits(values["limits"])
