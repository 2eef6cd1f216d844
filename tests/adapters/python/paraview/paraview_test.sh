#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Runs a script in ParaView, in which all checks must pass. Arguments: the source folder, the folder
# of the package, Python, the script, and a command that writes the files to read where it is run.
set -uo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
here=$(cd "$(dirname "$0")" && pwd)
(cd "$work" && "${@:5}") || exit 1
bash "$here/pvpython.sh" "$1" "$2" "$3" "$here/$4" "$work" >"$work/out" 2>&1
status=$?
[ $status = 0 ] && grep -q "^all checks passed" "$work/out" && exit 0
cat "$work/out"
exit $((status == 0 ? 1 : status))
