"""What is said where an optional package is missing can be done, from a checkout too."""

import tomllib

import pytest

from tests.conftest import ROOT
from toongeo._extras import REQUIREMENTS, missing_extra


@pytest.mark.parametrize("extra", REQUIREMENTS)
def test_the_packages_are_those_of_the_extra(extra):
    declared = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]
    # The cluster has the extra of batches too, which whoever misses dask may have.
    assert [one for one in declared[extra] if not one.startswith("toongeo[")] == [REQUIREMENTS[extra]]
    assert missing_extra("It", extra).endswith(f'pip install "{REQUIREMENTS[extra]}"')
