# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Checks of arguments: each wrong one gets a sentence that says where, what, and what is expected.

A kind is a function that converts a value, or raises Unfit. takes() calls those of a function
before it, and writes what several functions share into their help.
"""

from __future__ import annotations

import difflib
import functools
import inspect
import math
import operator
import os
import textwrap
from types import MappingProxyType
from typing import Any, Callable, Iterable, Literal, Mapping, ParamSpec, TypeVar, get_args

import numpy as np

from ._nestgrid import InvalidInput

Kind = Callable[[Any], Any]
P = ParamSpec("P")
R = TypeVar("R")

#: Where edges of coarse elements are cut.
Cuts = Literal["linear", "finest"]
#: What a threshold is compared with.
Indicator = Literal["offset", "deviation", "visual", "numerical", "wavelet", "norm", "geometry"]
#: What a threshold of an isosurface is compared with: also the errors of that surface alone.
SurfaceIndicator = Literal[Indicator, "cut", "slope"]
#: Types of samples, as NumPy calls them.
SampleType = Literal[
    "uint8", "int8", "uint16", "int16", "uint32", "int32", "uint64", "int64", "float32", "float64"
]


class InvalidType(InvalidInput, TypeError):
    """An argument of a type that cannot be used, a missing argument, or one of an unknown name."""

    __module__ = "nestgrid"


class Unfit(Exception):
    """Why a value does not fit: a sentence without its subject, and the error to raise."""

    def __init__(self, why: str, error: type[InvalidInput] = InvalidType) -> None:
        super().__init__(why)
        self.error = error


def shown(value: Any) -> str:
    """A value in a message: its type, and the value where that is short."""
    if value is None:
        return "None"
    if isinstance(value, np.ndarray):
        return f"an array of the shape {value.shape} and the type {value.dtype}"
    text = repr(value)
    kind = type(value).__name__
    if len(text) > 40:
        return f"of the type {kind}"
    return text if isinstance(value, (bool, int, float)) else f"the {kind} {text}"


def not_a(what: str, value: Any) -> Unfit:
    return Unfit(f"is {shown(value)}, not {what}")


def suggestion(name: str, names: Iterable[str]) -> str:
    """"; did you mean '...'?" where one of the names is near, else nothing."""
    names = list(names)
    near = difflib.get_close_matches(name, names, 1, 0.6) or [
        each for each in names if each.lower() == name.lower()
    ]
    return f"; did you mean '{near[0]}'?" if near else ""


def number(value: Any) -> float:
    if isinstance(value, (str, bytes, bytearray)):
        raise not_a("a number", value)
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError):
        raise not_a("a number", value) from None


def not_negative(value: Any) -> float:
    result = number(value)
    if not result >= 0:
        raise Unfit(f"is not a number >= 0: it is {result:g}", InvalidInput)
    return result


def positive(value: Any) -> float:
    result = number(value)
    if not 0 < result < math.inf:
        raise Unfit(f"is not a finite number > 0: it is {result:g}", InvalidInput)
    return result


def whole(least: int, most: int = 2**63 - 1) -> Kind:
    def kind(value: Any) -> int:
        try:
            if isinstance(value, (bool, np.bool_)):
                raise TypeError
            whole_float = isinstance(value, (float, np.floating)) and float(value).is_integer()
            result = int(value) if whole_float else operator.index(value)
        except TypeError:
            raise not_a("a whole number", value) from None
        if not least <= result <= most:
            limits = f"below {least}" if result < least else f"above {most}"
            raise Unfit(f"is {result}, {limits}", InvalidInput)
        return result

    return kind


def flag(value: Any) -> bool:
    if isinstance(value, (bool, np.bool_)) or (isinstance(value, int) and value in (0, 1)):
        return bool(value)
    raise not_a("True or False", value)


def name_of(names: Any, others: Mapping[str, str] = MappingProxyType({})) -> Kind:
    """One of the names of a Literal.

    others  names that are used elsewhere, and which of these they mean
    """
    known: tuple[str, ...] = get_args(names)

    def kind(value: Any) -> str:
        listed = f"none of {', '.join(known[:-1])} and {known[-1]}"
        if not isinstance(value, str):
            raise Unfit(f"is {shown(value)}, {listed}")
        if value not in known:
            near = f"; did you mean '{others[value]}'?" if value in others else ""
            raise Unfit(f"'{value}' is {listed}{near or suggestion(value, known)}", InvalidInput)
        return value

    return kind


_C_TYPES = {"char": "int8", "uchar": "uint8", "short": "int16", "ushort": "uint16"}
_C_TYPES |= {"int": "int32", "uint": "uint32", "float": "float32", "double": "float64"}


def sample_type(value: Any) -> str:
    """A SampleType, also from a type of NumPy."""
    if isinstance(value, np.dtype) or (isinstance(value, type) and issubclass(value, np.generic)):
        value = np.dtype(value).name
    result: str = name_of(SampleType, _C_TYPES)(value)
    return result


def optional(kind: Kind) -> Kind:
    return lambda value: None if value is None else kind(value)


def text(value: Any) -> str:
    if not isinstance(value, str):
        raise not_a("a text", value)
    return value


def path(value: Any) -> str:
    try:
        return os.fsdecode(os.fspath(value))
    except TypeError:
        raise not_a("a path", value) from None


def array(value: Any) -> np.ndarray:
    """An array of numbers of any type; masked ones are nan."""
    if np.ma.is_masked(value):
        value = _with_holes(value)
    try:
        if isinstance(value, (str, bytes, bytearray, dict, set)) or value is None:
            raise TypeError
        if isinstance(value, Iterable) and not hasattr(value, "__len__"):
            value = list(value)
        result = np.asarray(value)
        if result.dtype.kind not in "biuf" and result.size:
            raise TypeError
        return result
    except (TypeError, ValueError):
        raise not_a("numbers", value) from None


def numbers(value: Any) -> np.ndarray:
    """An array of float64."""
    return array(value).astype(float, copy=False)


def several(value: Any) -> list[float]:
    """One number, or all of an array, after numbers()."""
    result: list[float] = numbers(value).ravel().tolist()
    return result


def vector(what: str, value: Any, count: int | None = 3) -> np.ndarray:
    """So many numbers.

    what  their name in messages, where they are not the whole argument
    """
    try:
        result = numbers(value)
    except Unfit as unfit:
        raise (Unfit(f"is wrong: {what} {unfit}") if what else unfit) from None
    if result.ndim != 1 or (count is not None and len(result) != count):
        has = f"has {len(result)} numbers" if result.ndim == 1 else f"is {shown(result)}"
        told = f"is wrong: {what} {has}" if what else has
        raise Unfit(f"{told}, not {count or 'a list of numbers'}", InvalidInput)
    return result


def point(value: Any) -> np.ndarray:
    return vector("", value)


def shape(*parts: tuple[str, int]) -> Kind:
    """Several vectors and numbers, such as (centre, radius).

    parts  the name of each and how many numbers it has, 0 for one number alone
    """
    wanted = ", ".join(what for what, _ in parts)

    def kind(value: Any) -> tuple[Any, ...]:
        if isinstance(value, (str, bytes, dict, set)) or not hasattr(value, "__len__"):
            raise not_a(f"({wanted})", value)
        if len(value) != len(parts):
            raise Unfit(f"has {len(value)} parts, not ({wanted})", InvalidInput)
        result = []
        for (what, count), part in zip(parts, value):
            try:
                result.append(vector(what, part, count) if count else number(part))
            except Unfit as unfit:
                told = str(unfit) if count else f"is wrong: {what} {unfit}"
                raise Unfit(told, unfit.error) from None
        return tuple(result)

    return kind


def function_of_place(value: Any) -> tuple[Callable[[float, float, float], float], float]:
    """A function of x, y and z, or (function, steepness)."""
    function, steepness = value if isinstance(value, tuple) and len(value) == 2 else (value, math.inf)
    if not callable(function):
        raise not_a("a function of x, y and z, or (function, steepness)", value)
    try:
        return function, not_negative(steepness)
    except Unfit as unfit:
        raise Unfit(f"is wrong: the steepness {unfit}", unfit.error) from None


def _with_holes(array: np.ma.MaskedArray) -> np.ndarray:
    """A copy with nan for masked entries, of a type that keeps all other numbers."""
    if array.dtype.kind not in "biuf":
        return np.ma.getdata(array)  # which is refused
    small = array.dtype.itemsize <= (4 if array.dtype.kind == "f" else 2)
    return np.ma.filled(array.astype(np.float32 if small else np.float64), np.nan)


def samples(value: Any) -> np.ndarray:
    """An array that is not copied where it is one without masked entries."""
    if isinstance(value, (str, bytes, dict, set)) or value is None or callable(value):
        raise not_a("an array of 2 or 3 indices", value)
    if np.ma.is_masked(value):
        return _with_holes(value)
    try:
        return np.asanyarray(value)
    except ValueError:
        raise not_a("an array of 2 or 3 indices", value) from None


def sequence(kind: Kind, what: str) -> Kind:
    def each(value: Any) -> list[Any]:
        if isinstance(value, (str, bytes, dict, set)) or not isinstance(value, Iterable):
            raise not_a(what, value)
        result = []
        for i, part in enumerate(value):
            try:
                result.append(kind(part))
            except Unfit as unfit:
                raise Unfit(f"is wrong: its entry {i} {unfit}", unfit.error) from None
        return result

    return each


def function(value: Any) -> Callable[..., Any]:
    if not callable(value):
        raise not_a("a function", value)
    return value


class Argument:
    """An argument that several functions have: its kind, and its line in their help."""

    def __init__(self, kind: Kind, help: str) -> None:
        self.kind = kind
        self.help = help


#: By the name of the parameter. Modules add those of their types.
SHARED = {
    "threshold": Argument(
        optional(not_negative),
        "at least 0: detail up to it is left out, in the units of the indicator; None: 0, or "
        "with a lens infinity, so that the lens decides alone",
    ),
    "error": Argument(
        optional(not_negative),
        "at least 0, in the place of threshold, max_triangles and indicator: the data and their "
        "projection, which is drawn, differ by at most this, in units of the data",
    ),
    "position_error": Argument(
        optional(positive),
        "how far points of curved cells may be from where they are drawn, in units of length; "
        "None: the same share of the domain as error is of the range. For curved cells alone",
    ),
    "max_triangles": Argument(
        optional(whole(1)),
        "at least 1: the least threshold with no more triangles is found and used; threshold is "
        "then not",
    ),
    "indicator": Argument(
        name_of(Indicator),
        '"offset": |data - mean| in units of the data; "deviation": |data - what is drawn|, so '
        'that the threshold is the error; "visual": folds, 2 sin(angle / 2), from 0 to 2; '
        '"numerical": jumps of the gradient times the diameter, in units of the data; '
        '"wavelet": coefficients in units of the data; "norm": the Euclidean norm of the offsets '
        'of all components; "geometry": |position - mean| on curved grids, in units of length',
    ),
    "blend": Argument(
        number,
        "at least 1: nodes move from their mean to their value as the indicator grows from the "
        "threshold to this many times it; 1: they jump",
    ),
    "normals": Argument(flag, "whether to compute unit normals at the vertices, of gradients"),
    "elements": Argument(flag, "whether to keep what Surface.outlines() needs"),
    "threads": Argument(
        whole(0, 2**16),
        "how many work; 0: as many as the machine has. Results do not depend on it",
    ),
    "spacing": Argument(
        optional(numbers), "distance of samples along each index, in units of length; None: 1"
    ),
    "origin": Argument(optional(numbers), "position of the first sample; None: 0"),
    "direction": Argument(
        optional(numbers),
        "(d, d) for d indices: column i is the axis of index i in space; None: coordinate i",
    ),
    "name": Argument(text, "of the data, for files and tables"),
    "unit": Argument(text, 'of length, such as "mm"; "" where it is not known'),
}


def takes(**own: Kind) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Checks the arguments of a function.

    own  kinds of the parameters that are not in SHARED, or differ from it
    """

    def decorate(function: Callable[P, R]) -> Callable[P, R]:
        signature = inspect.signature(function)
        where = function.__qualname__.removesuffix(".__init__").split(".")[-1]
        kinds = {
            name: own[name] if name in own else SHARED[name].kind
            for name in signature.parameters
            if name != "self"
        }

        @functools.wraps(function)
        def checked(*args: P.args, **kwargs: P.kwargs) -> R:
            try:
                bound = signature.bind(*args, **kwargs)
            except TypeError as error:
                raise InvalidType(f"{where}(): {_misfit(signature, args, kwargs, error)}") from None
            for name, value in bound.arguments.items():
                if name == "self":
                    continue
                try:
                    bound.arguments[name] = kinds[name](value)
                except Unfit as unfit:
                    raise unfit.error(f"{where}(): {name} {unfit}") from None
            return function(*bound.args, **bound.kwargs)

        checked.__doc__ = _with_shared(function.__doc__, signature)
        return checked

    return decorate


def _misfit(
    signature: inspect.Signature, args: tuple[Any, ...], kwargs: dict[str, Any], error: TypeError
) -> str:
    """Why arguments do not fit a signature."""
    names = [name for name in signature.parameters if name != "self"]
    for name in kwargs:
        if name not in names:
            listed = f"it has {', '.join(names)}" if names else "it has none"
            return f"there is no argument '{name}', {listed}{suggestion(name, names)}"
    positional = [
        name
        for name, parameter in signature.parameters.items()
        if parameter.kind is inspect.Parameter.POSITIONAL_OR_KEYWORD
    ]
    if len(args) > len(positional):
        count = len(args) - ("self" in positional)
        allowed = ", ".join(name for name in positional if name != "self") or "none"
        return f"there are {count} arguments without a name, which only these may be: {allowed}"
    given = {*positional[: len(args)], *kwargs}
    for name, parameter in signature.parameters.items():
        if parameter.default is inspect.Parameter.empty and name not in given:
            return f"the argument '{name}' is missing"
    return str(error)


def documented(doc: str) -> set[str]:
    """The names that begin a line of arguments in a docstring."""
    names: set[str] = set()
    for line in doc.splitlines():
        head, _, rest = line.strip().partition("  ")
        if rest.strip() and all(each.isidentifier() for each in head.split(", ")):
            names.update(head.split(", "))
    return names


def _with_shared(doc: str | None, signature: inspect.Signature) -> str | None:
    """A docstring with the lines of the shared arguments that it does not tell itself."""
    if doc is None:
        return None
    doc = inspect.cleandoc(doc)
    own = documented(doc)
    missing = [name for name in signature.parameters if name in SHARED and name not in own]
    if not missing:
        return doc
    width = max(len(name) for name in missing) + 2
    lines = [
        textwrap.fill(
            name.ljust(width) + SHARED[name].help, 100, subsequent_indent=" " * width
        )
        for name in missing
    ]
    paragraphs = doc.split("\n\n")
    ends = [i for i, each in enumerate(paragraphs) if each.startswith(("Raises", "Returns"))]
    at = ends[0] if ends else len(paragraphs)
    return "\n\n".join([*paragraphs[:at], "\n".join(lines), *paragraphs[at:]])
