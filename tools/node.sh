#!/usr/bin/env bash
# Sees to a Node.js that is new enough for the pages, the clients and the tests: node.sh PYTHON. Where the
# machine has none, PYTHON's virtual environment gets one as a package, beside its other programs.
set -euo pipefail
python=$(realpath -s "${1:?which Python?}")
cd "$(dirname "$0")/.."

# What Vite asks for; Playwright and the clients are content with less.
suits() {
  command -v node >/dev/null && command -v npm >/dev/null && node -e '
    const [major, minor] = process.versions.node.split(".").map(Number);
    process.exit(major > 22 || (major === 22 && minor >= 12) || (major === 20 && minor >= 19) ? 0 : 1)'
}

export PATH="$(dirname "$python"):$PATH"
suits || "$python" -m pip --disable-pip-version-check --quiet install \
  --require-hashes -r requirements-node.lock
