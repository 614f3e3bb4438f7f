"""Arrays of users: which are read in place, which are copied once, and which are refused."""

from __future__ import annotations

import operator
import os
import warnings
from typing import Any, Mapping

import numpy as np
import numpy.typing as npt

from ._core import Error

_warned_about_device = False


def as_numpy(value: Any, what: str) -> npt.NDArray[Any]:
    """Returns a NumPy array of the same memory where possible.

    Arrays of other libraries come by DLPack: PyTorch, JAX, Warp, CuPy. Memory of a device is copied to the
    host, with a warning the first time.
    """
    global _warned_about_device
    if isinstance(value, np.ma.MaskedArray):
        raise Error(
            f"{what} are a masked array; decide what masked rows mean: use .compressed() or .filled()"
        )
    if isinstance(value, np.ndarray):
        return value
    if hasattr(value, "requires_grad") and hasattr(value, "detach"):
        value = value.detach()
    if hasattr(value, "__dlpack_device__"):
        if int(value.__dlpack_device__()[0]) != 1:
            if not _warned_about_device:
                _warned_about_device = True
                warnings.warn(
                    f"{what} are in the memory of a device and are copied to the host in each call",
                    RuntimeWarning,
                    stacklevel=4,
                )
            for to_host in ("cpu", "get", "numpy"):
                if hasattr(value, to_host):
                    return as_numpy(getattr(value, to_host)(), what)
            return np.asarray(value)
        try:
            return np.from_dlpack(value)
        except (BufferError, RuntimeError, TypeError):
            pass
    try:
        return np.asarray(value)
    except ValueError as error:
        raise Error(f"{what} must be an array: {error}") from None


def _plain(array: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """The array if its scalars are aligned and a whole number of scalars apart; else a copy."""
    size = array.dtype.itemsize
    is_plain = array.flags.aligned and all(stride % size == 0 for stride in array.strides)
    return array if is_plain else np.array(array, order="C")


def positions(value: Any, what: str = "positions") -> npt.NDArray[Any]:
    """An (n, 3) array of float32 or float64. Whole numbers become float64 and float16 becomes float32."""
    if type(value) is np.ndarray and value.dtype.char in "fd" and value.ndim == 2 and value.shape[1] == 3:
        size = value.itemsize
        if (
            value.flags.aligned
            and value.dtype.isnative
            and not any(stride % size for stride in value.strides)
        ):
            return value  # the usual case, in a microsecond
    array = as_numpy(value, what)
    if not array.dtype.isnative:
        array = array.astype(array.dtype.newbyteorder("="))
    if array.dtype not in (np.float32, np.float64):
        if array.dtype.kind in "iu" or array.size == 0:
            if array.size and max(int(array.max()), -int(array.min())) > 2**53:
                raise Error(f"{what} are {array.dtype} with numbers beyond 2^53, which float64 cannot hold")
            array = array.astype(np.float64)
        elif array.dtype == np.float16:
            array = array.astype(np.float32)
        else:
            raise Error(f"{what} are {array.dtype}; they must be float32, float64, float16 or whole numbers")
    if array.ndim == 2 and array.shape[1] == 3:
        return _plain(array)
    if array.size == 0:
        return np.empty((0, 3))
    hint = "; use .T" if array.ndim == 2 and array.shape[0] == 3 else ""
    hint = "; use .reshape(-1, 3)" if array.ndim == 1 and array.size % 3 == 0 else hint
    raise Error(f"{what} have the shape {array.shape}; it must be (n, 3){hint}")


def triangles(value: Any, what: str = "triangles") -> npt.NDArray[Any]:
    """An (m, 3) array of vertex ids: int32, int64, uint16 or uint32, others are converted."""
    array = as_numpy(value, what)
    if array.size == 0:
        return np.empty((0, 3), np.int64)
    if array.dtype.kind not in "iu":
        raise Error(f"{what} are {array.dtype}; they must be whole numbers, the ids of vertices")
    if array.ndim != 2 or array.shape[1] != 3:
        hint = "; divide polygons into triangles" if array.ndim == 2 and array.shape[1] > 3 else ""
        raise Error(f"{what} have the shape {array.shape}; it must be (m, 3){hint}")
    if not array.dtype.isnative:
        array = array.astype(array.dtype.newbyteorder("="))
    if array.dtype in (np.int32, np.int64, np.uint16, np.uint32):
        return _plain(array)
    if array.dtype == np.uint64 and array.max() > np.uint64(2**63 - 1):
        raise Error(f"{what} have the vertex {array.max()}; ids are at most 4294967295")
    return array.astype(np.int64)


def ids(value: Any, what: str, columns: int = 0) -> npt.NDArray[np.uint32]:
    """A list of ids, or a matrix with this number of columns, as uint32."""
    array = as_numpy(value, what)
    shape = (-1, columns) if columns else (-1,)
    if array.size == 0:
        return np.empty((0, columns) if columns else 0, np.uint32)
    if array.dtype.kind not in "iub" or (array.dtype.kind == "b" and columns):
        raise Error(f"{what} are {array.dtype}; they must be whole numbers")
    if array.ndim != (2 if columns else 1) or (columns and array.shape[1] != columns):
        raise Error(
            f"{what} have the shape {array.shape}; it must be " + (f"(n, {columns})" if columns else "(n,)")
        )
    if array.dtype.kind == "b":
        raise Error(f"{what} are truth values; they must be whole numbers: use numpy.flatnonzero")
    if array.min() < 0 or array.max() > 0xFFFFFFFF:
        worst = array.min() if array.min() < 0 else array.max()
        raise Error(f"{what} have the number {worst}; it must be from 0 to 4294967295")
    return np.ascontiguousarray(array, dtype=np.uint32).reshape(shape)


def doubles(value: Any, what: str, *shape: int) -> npt.NDArray[np.float64]:
    """An array of float64 without gaps with this shape; -1 is any size."""
    array = as_numpy(value, what)
    if array.size == 0:
        return np.empty([max(size, 0) for size in shape])
    if array.dtype.kind not in "iuf":
        raise Error(f"{what} are {array.dtype}; they must be numbers")
    if array.ndim != len(shape) or any(
        a not in (b, array.shape[i] if b == -1 else b) for i, (a, b) in enumerate(zip(array.shape, shape))
    ):
        wanted = ", ".join("n" if size == -1 else str(size) for size in shape)
        raise Error(
            f"{what} have the shape {array.shape}; it must be ({wanted}{',' if len(shape) == 1 else ''})"
        )
    return np.ascontiguousarray(array, dtype=np.float64)


def count(value: Any, what: str, least: int = 0, most: int = 0xFFFFFFFF) -> int:
    """A whole number in a range."""
    try:
        number = operator.index(value)
    except TypeError:
        raise Error(f"{what} is {value!r}; it must be a whole number from {least} to {most}") from None
    if not least <= number <= most:
        raise Error(f"{what} is {number}; it must be a whole number from {least} to {most}")
    return number


def number(value: Any, what: str) -> float:
    """A number."""
    if isinstance(value, (bool, str)) or not hasattr(value, "__float__"):
        raise Error(f"{what} is {value!r}; it must be a number")
    return float(value)


def function(value: Any, what: str, of: str) -> None:
    """Raises a `TypeError` unless it is a function of the user, or None."""
    if value is not None and not callable(value):
        raise TypeError(f"{what} is {value!r}; it must be a function of {of}, or None")


def path(value: Any, what: str) -> str:
    """The path of a file."""
    if not isinstance(value, (str, os.PathLike)):
        raise TypeError(f"{what} is {value!r}; it must be a path: a text or a pathlib.Path")
    return os.fspath(value)


class NotCopied:
    """What owns memory of the library: `copy` and `pickle` would give a second owner of it."""

    __slots__ = ()

    def __reduce__(self) -> Any:
        raise TypeError(
            f"a supple.{type(self).__name__} cannot be copied or pickled; make a new one from the same meshes "
            "and options"
        )


def truth(value: Any, what: str) -> bool:
    """True or False, also of NumPy."""
    if not isinstance(value, (bool, np.bool_)):
        raise Error(f"{what} is {value!r}; it must be True or False")
    return bool(value)


def keywords(options: Mapping[str, Any]) -> dict[str, Any]:
    """Options with the truth values of Python."""
    return {key: bool(value) if isinstance(value, np.bool_) else value for key, value in options.items()}
