# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""How the programs that read files answer load(): what crashes in them ends them alone.

An answer is one line of JSON, which describes the volume or says what is wrong, and the bytes of
the samples behind it.
"""

from __future__ import annotations

import json
import os
import sys
from typing import Any, Callable, Mapping, Sequence

import numpy as np


class Refused(Exception):
    """A sentence, and whether the arguments are wrong, not the file.

    names  of what can be chosen, which load() adds to the sentence
    """

    def __init__(
        self, sentence: str, argument: bool = False, names: Sequence[str] = ()
    ) -> None:
        super().__init__(sentence)
        self.argument = argument
        self.names = names


def listed(names: Sequence[str]) -> str:
    return ", ".join(f"'{name}'" for name in names)


def packed(arrays: Mapping[str, tuple[np.ndarray, str]]) -> tuple[dict[str, Any], bytes]:
    """Arrays, each with its type, as an answer: what describes them, and their bytes."""
    parts = {each: np.ascontiguousarray(data, kind) for each, (data, kind) in arrays.items()}
    told = [(each, arrays[each][1], part.shape) for each, part in parts.items()]
    data = b"".join(part.tobytes() for part in parts.values())
    return {"arrays": told, "shape": [len(data)], "type": "uint8"}, data


def answer(read: Callable[[str, str], tuple[dict[str, Any], Any]]) -> None:
    """Writes what read(path, name) returns or refuses to where the standard output was."""
    out = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what libraries print is no part of the answer
    try:
        place, samples = read(sys.argv[1], sys.argv[2])
    except ImportError as error:
        needed = "reading it needs the package vtk (python3-vtk9 of Debian)"
        out.write(json.dumps({"error": f"{sys.argv[1]}: {needed}: {error}"}).encode() + b"\n")
    except Refused as refused:
        told = {"error": str(refused), "argument": refused.argument, "names": refused.names}
        out.write(json.dumps(told).encode() + b"\n")
    else:
        out.write(json.dumps(place).encode() + b"\n")
        out.write(samples)
    out.close()
