#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Runs a command on a display of its own. The server chooses the number and tells when it is ready, so
# that several start at once on a busy machine, which xvfb-run does not survive; and it does not begin
# anew when its last client has gone, which another client may meet.
set -uo pipefail
ready=$(mktemp)
Xvfb -displayfd 3 -screen 0 1280x1024x24 -nolisten tcp -noreset 3>"$ready" 2>/dev/null &
server=$!
trap 'kill $server 2>/dev/null; wait $server 2>/dev/null; rm -f "$ready"' EXIT
for _ in $(seq 600); do
    [ -s "$ready" ] && break
    kill -0 $server 2>/dev/null || break
    sleep 0.1
done
[ -s "$ready" ] || { echo "Xvfb did not start"; exit 1; }
DISPLAY=:$(cat "$ready") "$@"
