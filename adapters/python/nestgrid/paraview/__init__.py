# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Filters and a reader for ParaView.

python -m nestgrid.paraview PROGRAM ARGUMENTS...    runs paraview, pvpython or pvbatch with the
                                                    plugin loaded or ready to load
"""
from __future__ import annotations

import os

#: The plugin, for LoadPlugin() and Tools > Manage Plugins.
PLUGIN = os.path.join(os.path.dirname(__file__), "plugin", "nestgrid_filters.py")
#: A folder for PYTHONPATH, which lets ParaView 5.11 load plugins in Python 3.11.
STARTUP = os.path.join(os.path.dirname(__file__), "startup")


def environment() -> dict[str, str]:
    """The environment in which ParaView finds the package and the plugin."""
    packages = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    paths = [STARTUP, packages, os.environ.get("PYTHONPATH", "")]
    plugins = [os.path.dirname(PLUGIN), os.environ.get("PV_PLUGIN_PATH", "")]
    return {
        **os.environ,
        "PYTHONPATH": os.pathsep.join(filter(None, paths)),
        "PV_PLUGIN_PATH": os.pathsep.join(filter(None, plugins)),
    }
