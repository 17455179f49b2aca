#!/usr/bin/env bash
# Builds the pages for browsers into app/web/built: build-web.sh PYTHON.
set -euo pipefail
python=$(realpath -s "${1:?which Python?}")
cd "$(dirname "$0")/.."

tools/node.sh "$python"
export PATH="$(dirname "$python"):$PATH"
cd app/web
if [ ! -e node_modules/.package-lock.json ] || [ package-lock.json -nt node_modules/.package-lock.json ]; then
  npm ci --no-audit --no-fund --loglevel=error
  touch node_modules/.package-lock.json
fi
npm run --silent build -- --logLevel warn
touch built
