"""Plays operations in the 3D view: a button, a slider, the clock, and what goes on; the same in every panel."""

from dataclasses import dataclass

import FreeCAD
from freecad.toolaxis.gui.play.scene import MachineScene
from freecad.toolaxis.gui.widgets.fields import tell
from freecad.toolaxis.services.messages import line_of, shown
from freecad.toolaxis.services.time_left import clock
from freecad.toolaxis.services.tour import meeting
from PySide import QtCore

translate = FreeCAD.Qt.translate

#: Interval of the animation, ms, and steps of the slider.
_FRAME, _STEPS = 40, 100000
#: How many times faster than the machine, and in how many seconds all should be seen at first.
_SPEEDS, _PATIENCE = (1, 5, 20, 60, 240, 1000), 40.0


@dataclass(frozen=True)
class PlayWidgets:
    """What a panel has for playing.

    Attributes
    ----------
    play : QAbstractButton
    slide : QSlider
    speed : QComboBox
    clock, pointer, met : QLabel
        The time, what goes on, and how many collisions there are.
    still : QCheckBox or None
        Whether the camera stays with the machine's bed.
    """

    play: object
    slide: object
    speed: object
    clock: object
    pointer: object
    met: object
    still: object = None

    @classmethod
    def of(cls, form, still=None):
        """The widgets of a form, by their usual names.

        Parameters
        ----------
        form : QWidget
        still : QCheckBox, optional
        """
        return cls(form.play, form.slide, form.speed, form.clock, form.pointer, form.met, still)


class PlayBar(QtCore.QObject):
    """Plays operations that were laid out.

    Parameters
    ----------
    document : App.Document
    widgets : PlayWidgets
    """

    def __init__(self, document, widgets):
        super().__init__()
        self.document, self.widgets = document, widgets
        self.scene = MachineScene(document)
        self.laid = self.collisions = None
        self.place, self.hidden, self.looking = 0.0, [], False
        self.since = QtCore.QElapsedTimer()
        self.timer = QtCore.QTimer(self)
        self.timer.setInterval(_FRAME)
        self.timer.timeout.connect(self._tick)
        widgets.slide.setMaximum(_STEPS)
        for speed in _SPEEDS:
            widgets.speed.addItem(f"{speed}\u00d7", float(speed))
        widgets.play.clicked.connect(self.toggle)
        widgets.slide.valueChanged.connect(self._slid)
        widgets.met.linkActivated.connect(self._show_next)
        if widgets.still is not None:
            widgets.still.toggled.connect(self._turn_view)
        self.refresh()

    @property
    def running(self):
        """Whether it plays."""
        return self.timer.isActive()

    def show(self, laid, looks=False):
        """Put operations into the view, at their beginning.

        Parameters
        ----------
        laid : freecad.toolaxis.services.playing.PlayedTour
        looks : bool
            Whether the view turns to the machine.
        """
        self.clear()
        self.laid, self.looking = laid, True
        self.scene.show(laid.mounted, [one.tool for one in laid.operations])
        length, speed = laid.playback.length, self.widgets.speed
        speed.setCurrentIndex(next((k for k, times in enumerate(_SPEEDS) if length / times <= _PATIENCE),
                                   len(_SPEEDS) - 1))
        self.go(0.0)
        if looks and laid.mounted is not None:
            self.scene.look()
        self.refresh()

    def show_collisions(self, found):
        """Show what meets; where nothing was played yet, at the first collision.

        Parameters
        ----------
        found : freecad.toolaxis.services.playing.PlayedCollisions
        """
        self.collisions, self.looking = found, False
        places = self.places
        self.go(places[0][0] if places and self.place == 0 and not self.running else self.place)
        self.refresh()

    def give_up(self):
        """Say nothing of collisions: they could not be looked for."""
        self.looking = False
        self.refresh()

    def hide(self, things):
        """Hide objects, tools that stand on their passes, as long as this one plays.

        Parameters
        ----------
        things : sequence of App.DocumentObject
        """
        for thing in things:
            if thing.ViewObject is not None and thing.ViewObject.Visibility:
                thing.ViewObject.Visibility = False
                self.hidden.append(thing.Name)

    @property
    def places(self):
        """Where something meets, as `PlayedCollisions.places` has it."""
        return [] if self.collisions is None or self.laid is None else self.collisions.places(self.laid.playback)

    def toggle(self):
        """Play, from the beginning again at the end, or pause."""
        if self.laid is None:
            return
        if self.running:
            self.timer.stop()
        else:
            if self.place >= 1:
                self.go(0.0)
            self.since.start()
            self.timer.start()
        self.refresh()

    def pause(self):
        """Stop where it is."""
        self.timer.stop()
        self.refresh()

    def go(self, place):
        """Go to a place.

        Parameters
        ----------
        place : float
            0 to 1.
        """
        if self.laid is None:
            return
        self.place = min(max(place, 0.0), 1.0)
        slide = self.widgets.slide
        blocked = slide.blockSignals(True)
        slide.setValue(round(self.place * _STEPS))
        slide.blockSignals(blocked)
        self._stand()

    def refresh(self):
        """Lock what cannot be used, and say what the button does."""
        some = self.laid is not None
        for widget in (self.widgets.play, self.widgets.slide, self.widgets.speed, self.widgets.still):
            if widget is not None:
                widget.setEnabled(some)
        self.widgets.play.setText(translate("ToolAxis", "Pause") if self.running else translate("ToolAxis", "Play"))
        if not some:
            for label in (self.widgets.clock, self.widgets.pointer, self.widgets.met):
                tell(label, "")
            return
        tell(self.widgets.met, *self._count())

    def clear(self):
        """Take everything out of the view."""
        self.timer.stop()
        self.laid = self.collisions = None
        self.place = 0.0
        self.scene.clear()
        self.refresh()

    def leave(self):
        """Take everything out of the view, and show what was hidden."""
        self.timer.stop()
        self.scene.leave()
        for name in self.hidden:
            thing = self.document.getObject(name)
            if thing is not None and thing.ViewObject is not None:
                thing.ViewObject.Visibility = True
        self.hidden = []

    def forget(self):
        """Let go without touching the view, which goes with its document."""
        self.timer.stop()
        self.hidden, self.laid = [], None
        self.scene.forget()

    # moving

    def _tick(self):
        seconds = self.since.restart() / 1000 * (self.widgets.speed.currentData() or 1.0)
        self.go(self.place + seconds / self.laid.playback.length)
        if self.place >= 1:
            self.pause()

    def _slid(self, value):
        self.go(value / _STEPS)

    def _turn_view(self, _):
        self._stand()

    def _show_next(self, _):
        """Go to the next collision, after the last one to the first."""
        places = [place for place, _, _ in self.places]
        if places:
            self.pause()
            self.go(next((place for place in places if place > self.place + 1e-9), places[0]))

    def _stand(self):
        """Put everything where it stands now, in red what meets, and say so."""
        moment, row, where = self.laid.stand(self.place)
        near = None if self.collisions is None else self.collisions.at(moment)
        red, lines = names_of(near), [self._words(moment)]
        if self.laid.mounted is None:
            self.scene.stand_alone(*where, red, row)
            bodies, depth = set(), 0.0
        else:
            bodies, depth = meeting(self.laid.holding(row), where)
            still = self.widgets.still is not None and self.widgets.still.isChecked()
            self.scene.stand(where, red | bodies, still, row)
            lines.append(axes_text(self.laid.mounted, where))
        self.scene.redden(things_of(near, self.document))
        if bodies:
            lines.append(bodies_text(bodies, depth))
        if near is not None:
            lines.append(line_of(near.text))
        tell(self.widgets.pointer, "\n".join(lines), bool(bodies) or near is not None)
        whole, cutting = round(self.laid.playback.seconds), round(self.laid.playback.cutting)
        tell(self.widgets.clock, translate("ToolAxis", "{} of {}: cutting {}, non-cutting {}").format(
            clock(moment.seconds), clock(whole), clock(cutting), clock(whole - cutting)))

    def _words(self, moment):
        """What goes on."""
        from toolaxis.cldata.toolpath import Motion

        one = self.laid.operations[moment.operation]
        if moment.between:
            after = self.laid.operations[moment.operation + 1]
            if after.tool != one.tool:
                return translate("ToolAxis", "Tool change and index move to {}").format(after.label)
            return translate("ToolAxis", "Index move to {}").format(after.label)
        words = {Motion.CUT: translate("ToolAxis", "{}: cutting, pass {} of {}"),
                 Motion.ENTRY: translate("ToolAxis", "{}: lead-in, pass {} of {}"),
                 Motion.EXIT: translate("ToolAxis", "{}: lead-out, pass {} of {}"),
                 Motion.LINK: translate("ToolAxis", "{}: link, pass {} of {}")}
        path = one.path
        number = int((path.breaks[:-1] <= moment.motion).sum())
        return words[Motion(int(path.kind[moment.motion]))].format(one.label, number, path.passes)

    def _count(self):
        """How many collisions there are, with a link to the next one, and whether that is bad."""
        if self.collisions is None:
            return translate("ToolAxis", "Checking for collisions") if self.looking else "", False
        names = {"shank": translate("ToolAxis", "shank"), "holder": translate("ToolAxis", "holder"),
                 "machine": translate("ToolAxis", "bodies of the machine"),
                 "index moves": translate("ToolAxis", "index moves")}
        rest = ", ".join(names[name] for name in self.collisions.unchecked)
        rest = " " + translate("ToolAxis", "Not checked: {}.").format(rest) if rest else ""
        places = self.places
        if not places:
            return translate("ToolAxis", "No collisions found.") + rest, False
        link = f'<a href="next">{translate("ToolAxis", "show the next one")}</a>'
        return translate("ToolAxis", "Collisions: {} ({}).").format(len(places), link) + rest, True


def names_of(one):
    """Bodies and members of the tool that are red.

    Parameters
    ----------
    one : freecad.toolaxis.services.collisions.Collision, PathCollision or None
    """
    return set() if one is None else {one.member, one.body} - {""}


def things_of(one, document):
    """Objects of the document that are red.

    Parameters
    ----------
    one : freecad.toolaxis.services.collisions.Collision, PathCollision or None
    document : App.Document
    """
    thing = None if one is None or not one.thing else document.getObject(one.thing)
    return [] if thing is None else [thing]


def axes_text(mounted, joints):
    """Where the axes of a machine stand.

    Parameters
    ----------
    mounted : toolaxis.machine.setup.Mounting
    joints : (3 + m,) array
    """
    linear = "  ".join(f"{axis.name} {x:.1f}" for axis, x in zip(mounted.machine.linear, joints[:3], strict=True))
    return f"{linear}  {mounted.at(joints[3:]).removeprefix(' at ')}"


def bodies_text(names, depth):
    """Which bodies of a machine meet each other.

    Parameters
    ----------
    names : set of str
    depth : float
        mm
    """
    from toolaxis.machine.setup import in_tenths

    bodies = ", ".join(map(shown, sorted(names)))
    return translate("ToolAxis", "Collision: {}; {} mm deep").format(bodies, in_tenths(depth))
