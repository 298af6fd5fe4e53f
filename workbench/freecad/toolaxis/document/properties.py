"""Properties of objects: added where they are missing, so that older documents gain them when they are opened."""

from collections import namedtuple

#: `former` is what held in documents that were saved before there was the property.
Property = namedtuple("Property", "kind name group text fixed hidden choices former", defaults=(False, False, (), None))


def ensure(thing, properties):
    """Add the properties that an object does not have yet.

    Parameters
    ----------
    thing : App.DocumentObject
    properties : sequence of Property

    Returns
    -------
    list of str
        Names of those that were added.
    """
    known, added = set(thing.PropertiesList), []
    for one in properties:
        if one.name in known:
            if one.fixed and not one.hidden:  # an older version may have let the user edit it
                thing.setEditorMode(one.name, ["ReadOnly"])
            if not set(one.choices) <= set(thing.getEnumerationsOfProperty(one.name) or ()):  # it knew fewer
                value = getattr(thing, one.name)
                setattr(thing, one.name, [*one.choices, *({value} - set(one.choices))])
                setattr(thing, one.name, value)
            continue
        thing.addProperty(f"App::Property{one.kind}", one.name, one.group, one.text, 0, one.fixed, one.hidden)
        if one.choices:
            setattr(thing, one.name, list(one.choices))
        added.append(one.name)
    return added


def assign(thing, **values):
    """Set the properties that differ, so that nothing is touched without need.

    Parameters
    ----------
    thing : App.DocumentObject
    **values
    """
    for name, value in values.items():
        if getattr(thing, name) != value:
            setattr(thing, name, value)


class Proxy:
    """What every object of ours has in common: properties that are migrated, and nothing saved but the class.

    Parameters
    ----------
    thing : App.DocumentObject
    """

    Type = ""
    properties = ()

    def __init__(self, thing):
        thing.Proxy = self
        ensure(thing, self.properties)

    def onDocumentRestored(self, thing):
        """Give an object of an older version what it does not have yet."""
        added = ensure(thing, self.properties)
        assign(thing, **{one.name: one.former for one in self.properties
                         if one.name in added and one.former is not None})

    def dumps(self):
        """Nothing: all data stand in properties."""

    def loads(self, state):
        """Nothing: all data stand in properties."""
