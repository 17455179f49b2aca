#!/usr/bin/env bash
# Writes the lock files anew from pyproject.toml: names, versions and hashes, no addresses.
set -euo pipefail
cd "$(dirname "$0")/.."
flags=(--universal --python-version 3.11 --generate-hashes --no-annotate --no-header
       --no-emit-index-url --no-emit-find-links --quiet)
uv pip compile pyproject.toml "${flags[@]}" -o requirements.lock
uv pip compile pyproject.toml --group dev -c requirements.lock "${flags[@]}" -o requirements-dev.lock
uv pip compile pyproject.toml --group bench -c requirements-dev.lock "${flags[@]}" -o requirements-bench.lock
uv pip compile --group node "${flags[@]}" -o requirements-node.lock
