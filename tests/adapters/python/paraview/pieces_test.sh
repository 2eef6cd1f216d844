#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# ParaView reads and draws what ranks write. Arguments: the source folder, the folder of the
# package, Python, and the command that writes a surface to the two paths behind it.
set -uo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
here=$(cd "$(dirname "$0")" && pwd)
"${@:4}" "$work/surface.vtp" "$work/surface.pvtp" || exit 1
bash "$here/pvpython.sh" "$1" "$2" "$3" "$here/pieces.py" "$work" >"$work/out" 2>&1
status=$?
[ $status = 0 ] && grep -q "^all checks passed" "$work/out" && exit 0
cat "$work/out"
exit $((status == 0 ? 1 : status))
