# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""How fields and results show themselves in notebooks."""

from __future__ import annotations

import html
from typing import Sequence


def table(title: str, rows: Sequence[tuple[str, str]]) -> str:
    """A small table; all texts are escaped."""
    cells = "".join(
        f"<tr><th style='text-align:left'>{html.escape(key)}</th>"
        f"<td style='text-align:left'>{html.escape(value)}</td></tr>"
        for key, value in rows
    )
    return f"<table><caption>{html.escape(title)}</caption><tbody>{cells}</tbody></table>"
