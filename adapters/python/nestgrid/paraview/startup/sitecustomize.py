# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Python imports this when ParaView starts it.

ParaView 5.11.0 imports inspect.getargspec, which Python 3.11 has dropped; without it no plugin in
Python loads.
"""
import inspect

if not hasattr(inspect, "getargspec"):
    inspect.getargspec = inspect.getfullargspec
