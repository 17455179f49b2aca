# Tubeloom. `make run` sets everything up and serves; `make test` sets everything up and tests.

PYTHON ?= $(shell for python in python3.13 python3.12 python3.11 python3; do \
    $$python -c 'import sys; raise SystemExit(not (3, 11) <= sys.version_info < (3, 14))' \
    2>/dev/null && command -v $$python && break; done)
VENV := .venv
BIN := $(VENV)/bin
# Where the machine's Node.js is too old, the virtual environment has one.
export PATH := $(CURDIR)/$(BIN):$(PATH)
PORT ?= 8000
PIP := $(BIN)/python -m pip --disable-pip-version-check --quiet

WEB_SOURCES := $(shell find app/web/source app/web/*.json app/web/*.js clients/typescript/src clients/react-flow/src examples -type f 2>/dev/null)

.PHONY: help run setup setup-dev web test check format fresh bench faults load openapi palettes pictures lock clean

help:  ## list what can be made
	@grep -E '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):.*## /  \1\t/' | expand -t 14

run: setup  ## set up what is missing, and serve on http://127.0.0.1:$(PORT)
	@exec $(BIN)/tubeloom serve --port $(PORT)

setup: $(VENV)/runtime.done app/web/built  ## a virtual environment with what serving needs, and the pages
setup-dev: $(VENV)/dev.done app/web/built  ## … and what testing needs
web: app/web/built  ## build the pages for browsers

$(VENV)/bin/python:
	@test -n "$(PYTHON)" || { echo "Tubeloom needs Python 3.11, 3.12 or 3.13." >&2; exit 1; }
	$(PYTHON) -m venv $(VENV)

$(VENV)/runtime.done: requirements.lock pyproject.toml tools/system-packages.sh | $(VENV)/bin/python
	tools/system-packages.sh
	$(PIP) install --require-hashes -r requirements.lock
	$(PIP) install --no-deps --editable .
	@echo "Compiling kernels, once: some minutes …"
	$(BIN)/tubeloom layout examples/id3-clause-2.json -o $(VENV)/id3.json
	$(BIN)/tubeloom render examples/id3-clause-2.json -o $(VENV)/id3.glb
	$(BIN)/tubeloom render examples/id3-clause-2.json -o $(VENV)/id3.svg
	$(BIN)/tubeloom render examples/paper-curves.json -o $(VENV)/paper.glb
	$(BIN)/tubeloom layout examples/id3-clause-2.json --routing planes -o $(VENV)/planes.json
	$(BIN)/tubeloom layout examples/in-space.json -o $(VENV)/space.json
	$(BIN)/tubeloom layout examples/hif/e-coli.json --from hif -o $(VENV)/sheet.json
	$(BIN)/tubeloom layout examples/yosys/mux4.json --from yosys --placement layers -o $(VENV)/layers.json
	@touch $@

app/web/built: $(WEB_SOURCES) tools/build-web.sh tools/node.sh | $(VENV)/bin/python
	tools/build-web.sh $(BIN)/python

$(VENV)/dev.done: requirements-dev.lock tests/node/package-lock.json clients/typescript/package-lock.json $(VENV)/runtime.done
	tools/system-packages.sh test
	tools/node.sh $(BIN)/python
	$(PIP) install --require-hashes -r requirements-dev.lock
	cd tests/node && npm ci --no-audit --no-fund --loglevel=error
	cd clients/typescript && npm ci --no-audit --no-fund --loglevel=error
	@touch $@

$(VENV)/bench.done: requirements-bench.lock benchmarks/node/package-lock.json $(VENV)/dev.done
	tools/system-packages.sh bench
	$(PIP) install --require-hashes -r requirements-bench.lock
	cd benchmarks/node && npm ci --no-audit --no-fund --loglevel=error
	@touch $@

test: check  ## everything that must hold: checks, then all tests
	$(BIN)/python -m pytest -q --doctest-modules app
	$(BIN)/python -m pytest -n 2 --dist loadfile --no-loadscope-reorder

check: setup-dev  ## format, lint, types, import rules, of pages too
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	npm --prefix app/web run --silent check

format: setup-dev  ## put the code in order
	$(BIN)/ruff format .
	$(BIN)/ruff check --fix .

fresh:  ## prove both commands of the README on bare roots of Debian 12 and 13 (as root, some GB)
	$(if $(PYTHON),$(PYTHON),python3) tools/fresh.py $(FRESH)

bench: $(VENV)/bench.done  ## measure speed, beside peers, and print the tables
	$(BIN)/python -m benchmarks

faults: setup-dev  ## kill parts of the service in the midst of jobs, and see what becomes of them
	$(BIN)/python -m benchmarks.faults

load: $(VENV)/bench.done  ## measure the service under load, for some twenty minutes
	$(BIN)/python -m benchmarks.load $(LOAD)

pictures: setup-dev  ## draw the pictures of the docs anew
	$(BIN)/python -m tools.pictures

openapi: setup-dev  ## write openapi.json anew, and the types of the client for TypeScript
	$(BIN)/tubeloom openapi > openapi.json
	cd clients/typescript && npm run --silent generate

palettes: setup-dev  ## compute the palettes anew
	$(BIN)/python tools/palettes.py

lock:  ## resolve dependencies anew (needs uv)
	tools/lock.sh

clean:  ## remove everything that can be made again
	rm -rf $(VENV) app/web/built app/web/node_modules tests/node/node_modules benchmarks/node/node_modules clients/typescript/node_modules clients/typescript/dist .mypy_cache .ruff_cache .pytest_cache .hypothesis .benchmarks
