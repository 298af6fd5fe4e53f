"""The tab of the result: the map, axes tried by a click, what they cost, and the tool on its passes."""

import FreeCAD
from freecad.toolaxis.document.plan_account import account_of
from freecad.toolaxis.gui.axis_map.legend import Legend
from freecad.toolaxis.gui.axis_map.result_rows import fill, fill_baselines, measures, sentences
from freecad.toolaxis.gui.axis_map.widget import HemisphereMap, no_map
from freecad.toolaxis.gui.plan.account import fill_tools
from freecad.toolaxis.gui.plan.locks import AxisLocks
from freecad.toolaxis.gui.plan.orientation_curve import OrientationCurve
from freecad.toolaxis.gui.plan.outcome import left_to_clean_up
from freecad.toolaxis.services.background import BackgroundWork
from freecad.toolaxis.services.messages import shown
from PySide import QtCore

translate = FreeCAD.Qt.translate


class AxisView(QtCore.QObject):
    """Shows a plan and lets its axes be changed.

    Parameters
    ----------
    form : QWidget
        Of plan.ui.
    preview : object
        With `show(plan, op)`, `move(share)` and `clear()`.
    """

    changed = QtCore.Signal()
    """The plan has another axis."""
    told = QtCore.Signal(str)
    """A sentence for the message line; empty to clear it."""

    def __init__(self, form, preview):
        super().__init__()
        self.form, self.preview = form, preview
        empty = translate("ToolAxis", "The map of the tool axes appears here after Compute.")
        self.map, self.legend = HemisphereMap(form, empty), Legend(form)
        self.map.setObjectName("axisMap")
        form.mapLayout.addWidget(self.map)
        form.legendLayout.addWidget(self.legend)
        self.curve = OrientationCurve(form)
        form.curveLayout.addWidget(self.curve)
        self.curve.hovered.connect(form.pointer.setText)
        self.locks = AxisLocks()
        self.plan = self.found = None
        self.pictures, self.titles, self.left = {}, {}, set()
        self.growing, self.computed = {}, None
        self.tried = self._asked = None
        self.work = None
        self.map.hovered.connect(form.pointer.setText)
        self.map.picked.connect(self.try_axis)
        form.lock.clicked.connect(self.lock)
        form.best.clicked.connect(self.back_to_best)
        form.turnFeed.clicked.connect(self.try_other_feed)
        form.lockAxis.clicked.connect(lambda held: self._hold(self.locks.axis, held))
        form.lockFeed.clicked.connect(lambda held: self._hold(self.locks.feed, held))
        form.operation.currentIndexChanged.connect(self._show_operation)
        form.slide.valueChanged.connect(lambda value: self.preview.move(value / form.slide.maximum()))
        self.clear()

    @property
    def operation(self):
        """The operation whose map is shown; None without a plan."""
        index = self.form.operation.currentIndex()
        return self.plan.operations[index] if self.plan is not None and index >= 0 else None

    def clear(self):
        """Show no plan."""
        self.leave()
        self.plan, self.found, self.pictures, self.growing = None, None, {}, {}
        self.locks = AxisLocks()
        self.curve.show_options(())
        fill_baselines(self.form.baselines, ())
        self.show_account(None)
        self._offer([], -1)
        self._show_operation()

    def show(self, plan, pictures, titles=None, locks=None):
        """Show a plan.

        Parameters
        ----------
        plan : toolaxis.plan.plan.Plan
        pictures : dict of int to AxisPicture or None
            By the operations' numbers.
        titles : dict of int to str, optional
            What the faces are called, by their numbers.
        locks : AxisLocks, optional
        """
        self.titles, self.locks = titles or {}, locks or AxisLocks()
        self.curve.show_options(plan.options)
        fill_baselines(self.form.baselines, plan.baselines)
        self.show_account(account_of(plan) if len(plan.tools) > 1 else None)
        self.plan, self.found, self.pictures, self.growing = plan, plan, pictures, {}
        self.left = left_to_clean_up(plan)
        undone = [k for k, op in enumerate(plan.operations) if not op.done and op.number not in self.left]
        done = [k for k, op in enumerate(plan.operations) if op.done]
        # With several tools some rest nearly always has no axis: what is machined is shown first.
        first = done or undone if self._several else undone or done
        self._offer(self._titles(), (first or [0])[0])
        self._show_operation()

    def show_account(self, account):
        """Show what each of several tools does; the panel's message has the headline.

        Parameters
        ----------
        account : freecad.toolaxis.document.plan_account.PlanAccount or None
            Nothing is shown for None.
        """
        fill_tools(self.form.toolTable, account)

    @property
    def _several(self):
        """Whether the plan has several tools: its axes are not changed by hand."""
        return self.plan is not None and len(self.plan.tools) > 1

    def _offer(self, names, index):
        """Let the user choose from names."""
        combo = self.form.operation
        blocked = combo.blockSignals(True)
        combo.clear()
        combo.addItems(names)
        combo.setCurrentIndex(index)
        combo.blockSignals(blocked)
        combo.setVisible(len(names) > 1)

    def begin_growing(self):
        """Something of the next plan is about to be shown: the last one disappears."""
        if self.plan is not None:
            self.clear()

    def show_growing(self, picture, face, titles):
        """Show the map of a search that goes on, unless the user looks at another face's.

        Parameters
        ----------
        picture : AxisPicture
        face : toolaxis.shape.face.Face
            Which face it is of.
        titles : dict of int to str
            What all the faces are called, by their numbers, in their order; skins come to them one by one.
        """
        self.begin_growing()
        if not self.growing:
            self.titles, self.growing, self.computed = titles, dict.fromkeys(titles), None
        shown = self._grown
        self.growing[face.number] = picture, title_of(face, titles)
        follows = shown in (None, self.computed)
        self.computed = face.number
        texts = [grown[1] if grown and number not in titles else titles[number] if grown
                 else translate("ToolAxis", "{}: not begun").format(titles[number])
                 for number, grown in self.growing.items()]
        self._offer(texts, list(self.growing).index(face.number if follows else shown))
        if self._grown == face.number:
            self._show_operation()

    @property
    def _grown(self):
        """Number of the face whose growing map is shown; None without one."""
        index = self.form.operation.currentIndex()
        return list(self.growing)[index] if self.growing and index >= 0 else None

    def _growth(self):
        """A growing map, or None, and the sentence about it."""
        number = self._grown
        picture, title = self.growing[number] or (None, self.titles[number])
        if picture is None:
            return None, translate("ToolAxis", "{}: no axis tested yet").format(title)
        return picture, translate("ToolAxis", "{}: the axes tested so far").format(title)

    @property
    def operation_titles(self):
        """What the operations of the plan are called, by their numbers."""
        return {op.number: self._title(op) for op in self.plan.operations}

    def _titles(self):
        return [self._title(op) for op in self.plan.operations]

    def _title(self, op):
        title = title_of(op.face, self.titles)
        if self._several and op.done:
            title = f"{title}, T{op.tool.number}"
        if op.number in self.locks.axis | self.locks.feed:
            title = translate("ToolAxis", "{} (locked)").format(title)
        if self.plan.blades is not None and op.number in self.plan.blades.copies:
            title = translate("ToolAxis", "{} (turned copy)").format(title)
        if op.number in self.left:
            return translate("ToolAxis", "{}: rest material").format(title)
        return title if op.done else translate("ToolAxis", "{}: no axis").format(title)

    def leave(self):
        """Stop trying an axis."""
        if self.work is not None:
            self.work.leave()
            self.work = None

    def _show_operation(self, *_):
        self.leave()
        op = self.operation
        self.tried = None
        picture, text = self.pictures.get(op.number) if op is not None else None, ""
        if self.growing:
            picture, text = self._growth()
        self.map.show_picture(picture, "" if op is None else no_map(op.orientation))
        self.legend.show_picture(picture)
        self.form.pointer.setText("")
        self._show_numbers()
        self.show_tool()
        if text:
            self.form.cost.setText(text)

    def show_tool(self):
        """Show passes and tool of the tried axis, or of the plan's, in the 3D view."""
        op = self.tried or self.operation
        if op is None:
            self.preview.clear()
        else:
            self.preview.show(self.plan, op)
            self.preview.move(self.form.slide.value() / self.form.slide.maximum())

    def _show_numbers(self):
        op, form = self.operation, self.form
        columns = [] if op is None else [(translate("ToolAxis", "Plan"), self._measures(op))]
        if self.tried is not None:
            columns.append((translate("ToolAxis", "Tried"), self._measures(self.tried)))
        fill(form.results, columns)
        form.results.setVisible(op is not None)
        form.cost.setText(self._cost())
        form.reasons.setText("" if op is None else sentences((self.tried or op).orientation))
        form.lock.setEnabled(self.tried is not None and self.tried.done)
        form.best.setEnabled(op is not None and op is not self._best(op))
        moves = op is not None and op.orientation.lead is not None
        for widget in (form.slide, form.slideLabel, form.pictures, form.playAll):
            widget.setVisible(op is not None)
        for widget in (form.lock, form.best, form.lockAxis, form.lockFeed, form.turnFeed):
            widget.setVisible(op is not None and not moves and not self._several)
        for widget in (form.mapPlace, form.legendPlace, form.pointer):
            widget.setVisible(not moves)
        own = op is not None and op.done and not self._is_copy(op)
        for box, held in ((form.lockAxis, self.locks.axis), (form.lockFeed, self.locks.feed)):
            box.setEnabled(own)
            box.setChecked(own and op.number in held)
        form.turnFeed.setEnabled(own)
        form.slide.setEnabled(op is not None and (self.tried or op).done)

    def _measures(self, op):
        """Rows of the result table for an operation; both that are compared have the same."""
        rates = self.plan.inputs.at_rates_of(op.tool)
        seconds = [one.seconds(rates.feedrate, rates.rapid) if one.done else 0.0
                   for one in (op, *([] if self.tried is None else [self.operation, self.tried]))]
        return measures(op.orientation, seconds[0] if all(seconds) else 0.0)

    def _is_copy(self, op):
        return self.plan.blades is not None and op.number in self.plan.blades.copies

    def _hold(self, held, locked):
        """Lock or unlock axis or feed of the operation that is shown."""
        if self.operation is None:
            return
        (held.add if locked else held.discard)(self.operation.number)
        index = self.form.operation.currentIndex()
        self._offer(self._titles(), index)
        self.changed.emit()

    def try_other_feed(self):
        """Try the other feed with the axis that is shown."""
        op = self.tried or self.operation
        if op is not None and op.done:
            self.try_axis(op.orientation.axis, "v" if op.orientation.feed == "u" else "u")

    def _best(self, op):
        return next(one for one in self.found.operations if one.number == op.number)

    def _cost(self):
        """What the tried axis costs against the best one, a sentence."""
        if self.operation is None:
            return ""
        if self.operation.orientation.lead is not None:
            return translate("ToolAxis", "The axis moves along the passes: lines in the 3D view show it.")
        if self._several:
            return self.operation.tool.shop_name
        if self.tried is None:
            return translate("ToolAxis", "Click on the map to try an axis.") if self.map.picture is not None else ""
        found, best = self.tried.orientation, self._best(self.operation).orientation
        if not self.tried.done:
            return translate("ToolAxis", "This axis cannot be used.")
        if best.axis is None:
            return translate("ToolAxis", "This axis can be used.")
        return translate("ToolAxis", "Against the best axis: {:+d} passes, {:+.1f} % cutting length, {:+.1f} % strip "
                                     "width.").format(found.passes - best.passes, _percent(found.length, best.length),
                                                      _percent(found.average_strip_width, best.average_strip_width))

    def try_axis(self, axis, feed=None):
        """Try an axis off the GUI thread.

        Parameters
        ----------
        axis : (3,) array
        feed : "u" or "v", optional
            The one that is locked, or the better one, unless given.
        """
        from toolaxis.job.planning.edit_axis import try_axis

        plan, op = self.plan, self.operation
        if op is None or not self.map.isEnabled() or self._is_copy(op) or self._several:
            return
        self.leave()
        self._asked = feed
        if feed is None and op.number in self.locks.feed:
            feed = op.orientation.feed
        self.map.show_tried(axis)
        self.legend.show_picture(self.map.picture, tried=True)
        self.form.cost.setText(translate("ToolAxis", "Trying this axis..."))
        self.work = BackgroundWork(lambda progress: try_axis(plan, op, axis, feed, progress=progress))
        self.work.progressed.connect(self._trying)
        self.work.done.connect(self._tried)
        self.work.failed.connect(self._failed)
        self.work.cancelled.connect(lambda: self._failed(""))
        self.work.start()

    def _trying(self, stage, share):
        names = {"axes": translate("ToolAxis", "screening"), "passes": translate("ToolAxis", "making passes"),
                 "proof": translate("ToolAxis", "checking for gouges and collisions")}
        self.form.cost.setText(translate("ToolAxis", "Trying this axis: {}...").format(names.get(stage, shown(stage))))

    def _tried(self, operation):
        self.work = None
        self.tried = operation
        self._show_numbers()
        self.show_tool()

    def _failed(self, message):
        self.work = None
        self.tried = None
        self.map.show_tried(None)
        self._show_numbers()
        self.told.emit(message)

    def lock(self):
        """Take the tried axis over into the plan."""
        if self.tried is not None and self.tried.done:
            self.locks.axis.add(self.tried.number)
            if self._asked is not None:
                self.locks.feed.add(self.tried.number)
            self._take(self.tried)

    def back_to_best(self):
        """Take the axis that the search found back into the plan."""
        if self.operation is not None:
            for held in (self.locks.axis, self.locks.feed):
                held.discard(self.operation.number)
            self._take(self._best(self.operation))

    def show_moved(self):
        """Show the plan again after its origin was moved."""
        self._show_operation()
        self.changed.emit()

    def _take(self, operation):
        from toolaxis.job.planning.edit_axis import with_operations

        self.plan = with_operations(self.plan, {operation.number: operation})
        self.left = left_to_clean_up(self.plan)
        picture = self.pictures.get(operation.number)
        if picture is not None:
            picture.mark_chosen(operation.orientation)
        self._offer(self._titles(), self.form.operation.currentIndex())
        self._show_operation()
        self.changed.emit()


def title_of(face, titles):
    """What a face or a sub-surface is called.

    Parameters
    ----------
    face : toolaxis.shape.face.Face
    titles : dict of int to str
        By the faces' numbers.
    """
    piece = face.label.removeprefix(str(face.number))
    return titles.get(face.number, translate("ToolAxis", "Face {}").format(face.number)) + piece


def _percent(value, base):
    return 100 * (value / base - 1) if base > 0 else 0.0
