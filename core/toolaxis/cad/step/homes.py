"""Faces of a STEP text that hang where kernels do not look for them get a model or a product."""

from collections.abc import Iterable

from toolaxis.cad.step.entities import Entities, Entity
from toolaxis.cad.step.faces import FACES, REPRESENTATIONS, SETS, SHELLS, find_referring, is_bounded_surface
from toolaxis.cad.step.mending import Mending, format_entities

SOLIDS = ("MANIFOLD_SOLID_BREP", "BREP_WITH_VOIDS", "FACETED_BREP")
MODELS = ("SHELL_BASED_SURFACE_MODEL", "FACE_BASED_SURFACE_MODEL")
TURNED = ("ORIENTED_CLOSED_SHELL", "ORIENTED_OPEN_SHELL")
#: What moves one representation into another: what hangs in none has no certain place then.
PLACING = ("NEXT_ASSEMBLY_USAGE_OCCURRENCE", "MAPPED_ITEM")


def model_of_shell(kind: str) -> str:
    """The kind of surface model that holds a kind of shell, empty for what is no shell.

    Parameters
    ----------
    kind : str
    """
    if kind in (*SHELLS[:2], *TURNED):
        return MODELS[0]
    return MODELS[1] if kind in SHELLS[2:] else ""


def give_models(mending: Mending) -> None:
    """Shells, faces and surfaces that a representation or a set lists as they are come into models of their own.

    Parameters
    ----------
    mending : Mending
    """
    entities = mending.entities
    loose = _Loose(mending)
    for holder in entities.of(*REPRESENTATIONS):
        members = mending.members(holder.number)
        items = [item for number in members for item in loose.items(number)]
        if items != members:
            mending.set_members(holder.number, dict.fromkeys(items))
    for what, numbers in loose.found.items():
        mending.notes.append(f"{some(what, numbers)} in no solid and no surface model of the file: read as surfaces "
                             "all the same")


class _Loose:
    """What stands where kernels do not look for it, and the models that it gets."""

    def __init__(self, mending: Mending) -> None:
        self.mending, self.entities = mending, mending.entities
        self.found: dict[str, list[int]] = {}
        self.models: dict[int, int] = {}
        listed_models = {number for holder in self.entities.of(*REPRESENTATIONS)
                         for number in self.entities.members(holder)}
        self.held = {number for model in self.entities.of(*SOLIDS, *MODELS) if model.number in listed_models
                     for number in self.entities.references(model)}

    def items(self, number: int) -> list[int]:
        """What a representation has to list in the place of one of its items."""
        kind = self.entities.kind(number)
        if kind in SETS:
            return self._of_set(number)
        keyword = model_of_shell(kind)
        if keyword:  # One that a solid has stands there already.
            return [] if number in self.held else [self._model("shells", number, keyword)]
        if is_bounded_surface(self.entities, number):
            return [self._model("surfaces", number, "GEOMETRIC_SET")]
        return [number]

    def _of_set(self, number: int) -> list[int]:
        """A set without the faces and shells that none may hold, and these beside it."""
        members = self.mending.members(number)
        wrong = [member for member in members
                 if self.entities.kind(member) in FACES or model_of_shell(self.entities.kind(member))]
        if not wrong:
            return [number]
        beside = [item for member in wrong for item in self.items(member)]
        faces = [member for member in wrong if self.entities.kind(member) in FACES]
        if faces:
            self.found.setdefault("faces", []).extend(faces)
        rest = [member for member in members if member not in wrong]
        return [self.mending.add("GEOMETRIC_SET", f"'',({format_entities(rest)})"), *beside] if rest else beside

    def _model(self, what: str, number: int, keyword: str) -> int:
        if number not in self.models:
            self.models[number] = self.mending.add(keyword, f"'',(#{number})")
            self.found.setdefault(what, []).append(number)
        return self.models[number]


def some(what: str, numbers: list[int]) -> str:
    """The beginning of a sentence about entities: how many, which, and that they stand somewhere.

    Parameters
    ----------
    what : str
        In the plural.
    numbers : list of int

    Examples
    --------
    >>> some("shells", [5, 6])
    '2 shells (#5, #6) stand'
    """
    named = ", ".join(f"#{number}" for number in numbers[:3]) + ", ..." * (len(numbers) > 3)
    one = len(numbers) == 1
    return f"{len(numbers)} {what[:-1] if one else what} ({named}) {'stands' if one else 'stand'}"


def give_products(mending: Mending, faces: Iterable[int]) -> frozenset[int]:
    """Representations that no product has get one, and so do faces in no representation.

    Parameters
    ----------
    mending : Mending
    faces : iterable of int
        Entity numbers of the faces that are wanted.

    Returns
    -------
    frozenset of int
        Faces in no product that get none: where the file has an assembly or is not whole, their place is not certain.
    """
    entities = mending.entities
    homeless = {number for number in faces if entities.kind(number) in FACES}
    used = _representations_of_products(entities)
    lonely: list[tuple[Entity, set[int]]] = []
    for holder in entities.of(*REPRESENTATIONS):
        own = find_referring(entities, [holder], FACES)
        if holder.number in used:
            homeless -= own
        else:
            lonely.append((holder, own))
    told = sorted(homeless)
    if told and (any(True for _ in entities.of(*PLACING)) or entities.dangling):
        return frozenset(told)
    for holder, own in lonely:
        if own & homeless:
            _add_product(mending, holder.number)
            homeless -= own
    if homeless:
        _house(mending, homeless)
    if told:
        mending.notes.append(f"{some('faces', told)} in no product of the file: read all the same, at the coordinates "
                             "that the file gives")
    return frozenset()


def _representations_of_products(entities: Entities) -> set[int]:
    """Representations that a product has, directly or over relationships."""
    used = {number for entity in entities.of("SHAPE_DEFINITION_REPRESENTATION", "REPRESENTATION_MAP")
            for number in entities.references(entity)}
    related = [entities.references(entity)[:2] for entity in (
        *entities.of("SHAPE_REPRESENTATION_RELATIONSHIP", "REPRESENTATION_RELATIONSHIP"),
        *entities.complex_of("REPRESENTATION_RELATIONSHIP"))]
    size = -1
    while len(used) > size:
        size = len(used)
        for pair in related:
            if used.intersection(pair):
                used.update(pair)
    return used


def _house(mending: Mending, homeless: set[int]) -> None:
    """A representation for faces in none: of the solids, models and shells that hold them, or of the faces alone."""
    entities, rest = mending.entities, set(homeless)
    items: list[int] = []
    for holder in entities.of(*SOLIDS, *MODELS, *SHELLS):
        own = find_referring(entities, [holder], FACES)
        if own & rest:
            model = model_of_shell(holder.keyword)
            items.append(mending.add(model, f"'',(#{holder.number})") if model else holder.number)
            rest -= own
    context = _context(mending)
    _add_product(mending, mending.add("SHAPE_REPRESENTATION",
                                      f"'',({format_entities([*items, *sorted(rest)])}),#{context}"))


def _context(mending: Mending) -> int:
    """The context that has the units; a new one of mm where there is none."""
    for entity in mending.entities.complex_of("GLOBAL_UNIT_ASSIGNED_CONTEXT"):
        return entity.number
    unit = mending.add("", "LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.)")
    angle = mending.add("", "NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.)")
    return mending.add("", "GEOMETRIC_REPRESENTATION_CONTEXT(3)"
                           f"GLOBAL_UNIT_ASSIGNED_CONTEXT((#{unit},#{angle}))REPRESENTATION_CONTEXT('','')")


def _add_product(mending: Mending, representation: int) -> None:
    """Everything from a representation up to a product."""
    application = mending.add("APPLICATION_CONTEXT", "'automotive_design'")
    product_context = mending.add("PRODUCT_CONTEXT", f"'',#{application},'mechanical'")
    product = mending.add("PRODUCT", f"'part','part','',(#{product_context})")
    formation = mending.add("PRODUCT_DEFINITION_FORMATION", f"'','',#{product}")
    context = mending.add("PRODUCT_DEFINITION_CONTEXT", f"'part definition',#{application},'design'")
    definition = mending.add("PRODUCT_DEFINITION", f"'design','',#{formation},#{context}")
    shape = mending.add("PRODUCT_DEFINITION_SHAPE", f"'','',#{definition}")
    mending.add("SHAPE_DEFINITION_REPRESENTATION", f"#{shape},#{representation}")
