"""Who made a VRM and what others may do with it."""

from dataclasses import dataclass, fields
from typing import Any, Literal, get_args, get_type_hints

__all__ = ["VrmMeta"]


@dataclass(frozen=True)
class VrmMeta:
    """The fields of a VRM 1.0 that tell its licence; unless told otherwise, nothing is allowed to others.

    The shape and the expressions are yours to license (the template is CC0). The texture comes from your picture: its
    licence is that of the picture.

    Attributes
    ----------
    name, version, copyright_information, contact_information, third_party_licenses : str
        Empty ones are left out, the name excepted.
    authors : tuple of str
        At least one.
    avatar_permission : {"onlyAuthor", "onlySeparatelyLicensedPerson", "everyone"}
        Who may act as the avatar.
    commercial_usage : {"personalNonProfit", "personalProfit", "corporation"}
    credit_notation : {"required", "unnecessary"}
    modification : {"prohibited", "allowModification", "allowModificationRedistribution"}
    allow_redistribution, allow_excessively_violent_usage, allow_excessively_sexual_usage : bool
    allow_political_or_religious_usage, allow_antisocial_or_hate_usage : bool

    Raises
    ------
    ValueError
        If a field is of another type or none of its values, or name or authors are empty.

    Examples
    --------
    >>> VrmMeta(name="Ada", authors=("Grace",)).entry()["creditNotation"]
    'required'
    """

    name: str = "toongeo avatar"
    authors: tuple[str, ...] = ("unknown",)
    version: str = ""
    copyright_information: str = ""
    contact_information: str = ""
    third_party_licenses: str = ""
    avatar_permission: Literal["onlyAuthor", "onlySeparatelyLicensedPerson", "everyone"] = "onlyAuthor"
    commercial_usage: Literal["personalNonProfit", "personalProfit", "corporation"] = "personalNonProfit"
    credit_notation: Literal["required", "unnecessary"] = "required"
    modification: Literal["prohibited", "allowModification", "allowModificationRedistribution"] = "prohibited"
    allow_redistribution: bool = False
    allow_excessively_violent_usage: bool = False
    allow_excessively_sexual_usage: bool = False
    allow_political_or_religious_usage: bool = False
    allow_antisocial_or_hate_usage: bool = False

    def __post_init__(self) -> None:
        for field, kind in get_type_hints(VrmMeta).items():
            value, choices = getattr(self, field), get_args(kind)
            if kind in (str, bool):
                fits, expected = type(value) is kind, kind.__name__
            elif field == "authors":
                fits, expected = isinstance(value, tuple) and all(type(v) is str and v for v in value), "names"
            else:
                fits, expected = value in choices, " or ".join(choices)
            if not fits or (field in ("name", "authors") and not value):
                raise ValueError(f"{field}: expected {expected}, got {value!r}")

    def entry(self) -> dict[str, Any]:
        """The JSON of it."""
        entry: dict[str, Any] = {"licenseUrl": "https://vrm.dev/licenses/1.0/"}
        for field in fields(self):
            value = getattr(self, field.name)
            first, *others = field.name.split("_")
            name = first + "".join(word.capitalize() for word in others)
            if value != "":
                entry[name] = list(value) if isinstance(value, tuple) else value
        return entry
