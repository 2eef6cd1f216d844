# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""For a pvpython that was unpacked and not installed: what is imported first stays, so that all of
VTK comes from PYTHONPATH and not from the system, whose VTK is another one."""
import vtkmodules  # noqa: F401
from nestgrid.paraview.startup import sitecustomize  # noqa: F401
