"""Pickles of numbers: what is read, and what is refused by name."""

import pickle
from collections import OrderedDict

import numpy as np
import pytest
from scipy import sparse

from toongeo.model.loaders.files.read_pickle import plain, unpickled


def read(value, protocol=2):
    return plain(unpickled(pickle.dumps(value, protocol)))


class State:
    """An array of numpy with a state of any kind, as damaged or hostile files have it."""

    def __init__(self, state):
        self.state = state

    def __reduce__(self):
        reconstruct, arguments, _ = np.zeros(1).__reduce__()
        return reconstruct, arguments, self.state


class Matrix:
    """A sparse matrix whose parts need not fit together."""

    def __init__(self, state):
        self.state = state

    def __reduce__(self):
        return sparse.csr_matrix, (), self.state


def parts(matrix, **others):
    known = {"_shape": matrix.shape, "data": matrix.data, "indices": matrix.indices, "indptr": matrix.indptr}
    return known | others


@pytest.mark.parametrize("protocol", [2, 3, 4])
@pytest.mark.parametrize("kind", ["<f8", ">f8", "<i4", ">u2", "|b1"])
def test_arrays_of_every_kind_are_read(kind, protocol):
    array = np.arange(24).reshape(2, 3, 4).astype(kind)
    found = read({"a": array, "b": np.asfortranarray(array)}, protocol)
    np.testing.assert_array_equal(found["a"], array)
    np.testing.assert_array_equal(found["b"], array)
    assert found["a"].dtype == array.dtype


def test_containers_are_read():
    numbers = [np.float64(0.1), np.array([1, "two", None], object)]
    found = read(OrderedDict(numbers=numbers, name="head", none=None))
    assert found == {"numbers": [0.1, [1, "two", None]], "name": "head", "none": None}


@pytest.mark.parametrize("kind", [sparse.csr_matrix, sparse.csc_matrix])
def test_sparse_matrices_are_read(kind):
    dense = np.arange(6.0).reshape(2, 3) % 4
    np.testing.assert_array_equal(read(kind(dense)), dense)


DTYPE = np.dtype("<f8")


@pytest.mark.parametrize(
    ("state", "told"),
    [
        (None, "no content"),
        ((1, (2,)), "no content"),
        ((1, (1,), DTYPE, False, 3), "objects, not numbers"),
        ((1, [1], DTYPE, False, b"12345678"), "objects, not numbers"),
        ((1, (-1,), DTYPE, False, b"12345678"), "has the shape"),
        ((1, (2,), DTYPE, False, b"12345678"), "has 8 bytes"),
        ((1, (1,), "f8", False, b"12345678"), "not numbers"),
        ((1, (1,), np.dtype("S8"), False, b"12345678"), "not numbers"),
    ],
)
def test_arrays_that_are_none_are_refused(state, told):
    with pytest.raises(ValueError, match=told):
        read({"a": State(state)})


EYE = sparse.csr_matrix(np.eye(3))


@pytest.mark.parametrize(
    ("state", "told"),
    [
        (parts(EYE, _shape=(10**5, 10**5)), "100000 x 100000"),
        (parts(EYE, _shape=(3, -1)), "3 x -1"),
        (parts(EYE, indptr=np.array([0, 2, 1, 3])), "does not fit together"),
        (parts(EYE, indptr=np.array([0, 3])), "does not fit together"),
        (parts(EYE, indices=np.array([0, 1, 3])), "out of range"),
        (parts(EYE, indices=np.array([0, 1])), "out of range"),
    ],
)
def test_sparse_matrices_that_do_not_fit_are_refused(state, told):
    with pytest.raises(ValueError, match=told):
        read(Matrix(state))


def test_a_sparse_matrix_without_parts_is_refused():
    with pytest.raises(ValueError, match="no content"):
        read(Matrix("text"))


def chumpy_of_python_2(class_name, state):
    """``copy_reg._reconstructor(class, object, None)`` and a state, as protocol 1 writes an object."""
    named = f"ccopy_reg\n_reconstructor\n(c{class_name}\nc__builtin__\nobject\nNtR".encode()
    return b"\x80\x02" + named + pickle.dumps(state, 2)[2:-1] + b"b."


def test_an_object_of_python_2_gives_the_numbers_that_it_holds():
    content = chumpy_of_python_2("chumpy.ch\nCh", {"x": np.arange(3.0)})
    np.testing.assert_array_equal(plain(unpickled(content)), np.arange(3.0))


def test_an_object_of_python_2_of_another_kind_is_nothing():
    assert plain(unpickled(chumpy_of_python_2("numpy\nndarray", {"x": np.arange(3.0)}))) is None
