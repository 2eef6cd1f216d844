#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Launches a compiler, or takes the object that another build with the same options has made of the
# same source. What would hide symbols is compiled: there is no such object.
# Arguments: the folder of the other build, the compiler and its arguments.
set -euo pipefail
first=$1
shift
object='' depends='' previous='' hidden=0
for argument in "$@"; do
    case $previous in
        -o) object=$argument ;;
        -MF) depends=$argument ;;
    esac
    case $argument in
        -fvisibility=hidden | -fvisibility-inlines-hidden) hidden=1 ;;
        -fvisibility=default) hidden=0 ;;
    esac
    previous=$argument
done
if [ "$hidden" = 0 ] && [ -n "$depends" ] && [ -f "$first/$object" ]; then
    cp "$first/$object" "$object"
    echo "$object:" >"$depends"
else
    exec "$@"
fi
