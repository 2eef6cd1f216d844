# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs a program of ParaView in which the plugin loads."""
import os
import sys

from . import environment

if len(sys.argv) < 2:
    sys.exit("usage: python -m nestgrid.paraview PROGRAM ARGUMENTS...")
try:
    os.execvpe(sys.argv[1], sys.argv[1:], environment())
except OSError as error:
    sys.exit(f"{sys.argv[1]} cannot be run: {error.strerror}")
