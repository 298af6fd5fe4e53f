"""Watches the document that a panel works on: closed, or a part deleted or changed under it."""

import FreeCAD


class DocumentObserver:
    """A document observer that tells one panel.

    Parameters
    ----------
    document : App.Document
    panel : object
        With `document_closed()`, `object_deleted(name)` and `object_changed(name)`.
    """

    def __init__(self, document, panel):
        self.name, self.panel = document.Name, panel
        FreeCAD.addDocumentObserver(self)

    def end(self):
        """Stop watching."""
        if self.panel is not None:
            self.panel = None
            FreeCAD.removeDocumentObserver(self)

    def slotDeletedDocument(self, document):
        """Called by FreeCAD before a document is closed."""
        if self.panel is not None and document.Name == self.name:
            self.panel.document_closed()

    def slotDeletedObject(self, thing):
        """Called by FreeCAD before an object is deleted."""
        if self.panel is not None and thing.Document is not None and thing.Document.Name == self.name:
            self.panel.object_deleted(thing.Name)

    def slotChangedObject(self, thing, name):
        """Called by FreeCAD after a property has changed."""
        if self.panel is not None and name in ("Shape", "Placement") and thing.Document.Name == self.name:
            self.panel.object_changed(thing.Name)
