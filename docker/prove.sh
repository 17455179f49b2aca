#!/bin/sh
# Builds what docker/Dockerfile describes without a Docker engine, runs it as Docker would (not as
# root, nothing writable but /tmp and the volume, no network but its own) and checks that it serves.
# Wants root, Debian's debootstrap and some 4 GB: docker/prove.sh FOLDER
set -eu
command -v debootstrap >/dev/null || { echo "Please run: apt-get install debootstrap" >&2; exit 1; }
[ "$(id -u)" = 0 ] || { echo "Only root may mount what is built." >&2; exit 1; }
here=$(cd "$(dirname "$0")" && pwd)
folder=${1:-$(mktemp -d)}
# What is mounted within, and whatever runs there, is gone at the end.
unshare --mount --propagation private python3 "$here/prove_build.py" "$folder"
unshare --mount --propagation private --pid --fork --mount-proc --net \
    python3 "$here/prove_run.py" "$folder"
