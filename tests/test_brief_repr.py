"""Objects with arrays print in a few lines."""

import dataclasses

import numpy as np
import pytest

import toongeo
from toongeo import driving, geometry, io, metrics, pipeline, render

ROOMS = (toongeo, driving, geometry, io, metrics, pipeline, render)
PUBLIC = {part for room in ROOMS for name in dir(room) if isinstance(part := getattr(room, name), type)}
WITH_ARRAYS = sorted(
    (
        part
        for part in PUBLIC
        if dataclasses.is_dataclass(part)
        and any(kind in str(f.type) for f in dataclasses.fields(part) for kind in ("ndarray", "NDArray", "Floats"))
    ),
    key=lambda part: part.__qualname__,
)


@pytest.mark.parametrize("part", WITH_ARRAYS, ids=lambda part: part.__name__)
def test_public_objects_that_hold_arrays_print_briefly(part):
    instance = object.__new__(part)
    for field in dataclasses.fields(part):
        object.__setattr__(instance, field.name, np.zeros((1000, 3)))
    fields = ", ".join(f"{field.name}=<float64 (1000, 3)>" for field in dataclasses.fields(part) if field.repr)
    assert repr(instance) == f"{part.__name__}({fields})"


def test_parts_are_named(avatar):
    assert repr(avatar).startswith("Avatar(fit=<FaceFit>, parse=<FaceParse>, face=<AlignedFace>, rig=<Rig>")
    assert "names=<tuple of 46>" in repr(avatar.rig) and "identity=<float64 (81,)>" in repr(avatar.fit)
    assert "eyes=(<EyeballTemplate>, <EyeballTemplate>)" in repr(avatar.fit.model)
    assert len(repr(avatar.fit.model)) < 700
