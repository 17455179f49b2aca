#!/usr/bin/env bash
# Builds the pages for browsers into app/web/built: build-web.sh PYTHON. Where there is no Node new
# enough, PYTHON's environment gets one as a package.
set -euo pipefail
python=$(realpath -s "${1:?which Python?}")
cd "$(dirname "$0")/.."

suits() {
  command -v node >/dev/null && command -v npm >/dev/null && node -e '
    const [major, minor] = process.versions.node.split(".").map(Number);
    process.exit(major > 22 || (major === 22 && minor >= 12) || (major === 20 && minor >= 19) ? 0 : 1)'
}

export PATH="$PATH:$(dirname "$python")"
if ! suits; then
  PATH="$(dirname "$python"):$PATH"
  suits || "$python" -m pip --disable-pip-version-check --quiet install \
    --require-hashes -r requirements-node.lock
fi
cd app/web
if [ ! -e node_modules/.package-lock.json ] || [ package-lock.json -nt node_modules/.package-lock.json ]; then
  npm ci --no-audit --no-fund --loglevel=error
  touch node_modules/.package-lock.json
fi
npm run --silent build -- --logLevel warn
touch built
