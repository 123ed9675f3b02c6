# Pleat. `make help` lists what there is; every target sets up what it needs first.

VENV := .venv
BIN := $(VENV)/bin
NODE := $(CURDIR)/$(BIN)/node
PIP := $(BIN)/python -m pip --disable-pip-version-check --quiet
# Bytecode is written by whoever first imports a module: most of the modules installed are never imported.
INSTALL := $(PIP) install --no-compile
# The pins are complete, and leave out what nothing imports (see UNUSED).
PINNED := --no-deps --require-hashes -r
PYTEST := $(BIN)/python -m pytest --rerun-show-tracebacks
# How many tests run at once: two more than cores, for tests of servers and browsers wait for a third of their time.
# Each wants some 2 GB with its server and its browser; where that is too much: make test JOBS=2
JOBS ?= $(shell echo $$(($$(getconf _NPROCESSORS_ONLN 2>/dev/null || echo 2) + 2)))

# Tests start a hundred processes: where the environment keeps Python from writing bytecode, each compiles all sources.
export PYTHONDONTWRITEBYTECODE :=

# Stamps: newer than the pinned requirements when what they ask for is installed.
READY := $(VENV)/.ready
READY_DEV := $(VENV)/.ready-dev
KERNELS := $(VENV)/.kernels-pr2 $(VENV)/.kernels-so101-pair
READY_JS := tests/js/node_modules/.ready
READY_BENCH := $(VENV)/.ready-bench
READY_DOCS := $(VENV)/.ready-docs

.DEFAULT_GOAL := help
.PHONY: help run check docs format lint types page-types imports kernels test-quick test test-long browser nginx bench figures pictures licences release-check lock clean

help: ## this list
	@sed -n 's/^\([a-z-]*\):.*## \(.*\)/  make \1 ~\2/p' Makefile | while IFS='~' read -r target text; do \
	    printf '%-18s %s\n' "$$target" "$$text"; done

run: $(READY) $(VENV)/.kernels-pr2 ## serve the designer on http://127.0.0.1:8000; make run PORT=8001 on another port
	@exec $(BIN)/pleat serve $(if $(PORT),--port $(PORT))

check: lint types page-types imports ## format, lint, types of Python and of the page's JavaScript, imports

format: $(READY_DEV) ## put the code into its format
	$(BIN)/ruff format .
	$(BIN)/ruff check --fix .

lint: $(READY_DEV)
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .

types: $(READY_DEV)
	$(BIN)/mypy

# The page's JavaScript is checked against the shapes of what the server sends: they are read off the server each time.
page-types: $(READY_DEV) $(READY_JS)
	$(BIN)/python -m tests.js.describe tests/js/openapi.json
	@cd tests/js && $(NODE) node_modules/openapi-typescript/bin/cli.js openapi.json --output api.d.ts >/dev/null
	cd tests/js && $(NODE) node_modules/typescript/bin/tsc --project .

imports: $(READY_DEV)
	$(PYTEST) tests/test_imports.py

kernels: $(KERNELS)

test-quick: $(READY_DEV) $(KERNELS) ## the tests that are quick and need no browser
	$(PYTEST) -n $(JOBS) --dist loadfile --no-loadscope-reorder -m "not browser and not slow and not long"

test: $(READY_DEV) $(KERNELS) browser nginx ## every test but the longest, the property laws on a few hundred random cases
	$(PYTEST) -n $(JOBS) --dist loadfile --no-loadscope-reorder -m "not long" --durations=50

test-long: $(READY_DEV) $(KERNELS) browser nginx ## every test, the laws on thousands of random cases
	$(PYTEST) -n $(JOBS) --dist loadfile --no-loadscope-reorder --hypothesis-profile=long

bench: $(READY) $(KERNELS) $(READY_BENCH) ## the benchmark tables, also as JSON under bench/out/; draws docs/growth.svg
	$(BIN)/python -m bench

docs: $(READY_DOCS) ## write the documents as a site to site/, which needs no network; strict
	@NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --quiet

figures: $(READY) $(KERNELS) ## draw the figures of docs/model.md from the planner
	$(BIN)/python -m docs.figures.draw

pictures: $(READY_DEV) $(KERNELS) browser ## take the pictures of the documents from the page
	$(BIN)/python -m docs.pictures.take

licences: $(READY_DEV) ## list the licence of each package that is installed; fail on one that is not known
	$(BIN)/python -m tests.licences

release-check: check docs licences test ## all that a release must pass, beside `make test-long`; its wheel is in dist/
	$(BIN)/python -m pip --disable-pip-version-check wheel --quiet --no-deps --no-build-isolation --wheel-dir dist .
	@ls dist

# The browser tests take Debian's Chromium where there is one, Playwright's own otherwise.
browser: $(READY_DEV)
	@test -x /usr/bin/chromium && exit 0; \
	if command -v apt-get >/dev/null; then \
	    if test "$$(id -u)" = 0; then sudo=; elif sudo -n true 2>/dev/null; then sudo="sudo -n"; else sudo=false; fi; \
	    $$sudo apt-get update -qq && \
	    $$sudo env DEBIAN_FRONTEND=noninteractive apt-get install -qq -y --no-install-recommends \
	        chromium $$(apt-cache pkgnames chromium-headless-shell); \
	fi; \
	test -x /usr/bin/chromium || $(BIN)/python -m playwright install chromium

# The proxy of the tests, unpacked and not installed: as a package it would start a server. They are skipped without it.
nginx: | $(BIN)/python browser
	@test -x /usr/sbin/nginx || test -x $(VENV)/nginx/usr/sbin/nginx || \
	{ command -v apt-get >/dev/null && cd $(VENV) && apt-get download -qq -o APT::Sandbox::User=root nginx && dpkg -x nginx_*.deb nginx && rm nginx_*.deb; } || \
	echo "There is no nginx here: its tests are left out"

# Pins for every machine: the versions of `requirements-dev.txt` hold for `requirements.txt` too.
COMPILE := $(BIN)/pip-compile --quiet --upgrade --strip-extras --allow-unsafe --generate-hashes \
    --no-header --no-emit-options --no-emit-index-url --no-emit-trusted-host --no-emit-find-links

# yourdfpy asks for all that trimesh can use, of which meshes of robots need pycollada alone.
UNUSED := colorlog embreex manifold3d mapbox-earcut rtree vhacdx xxhash
UNUSED_BESIDE_TESTS := $(UNUSED) attrs httpcore httpx jsonschema jsonschema-specifications referencing rpds-py
leave-out = awk -v names=" $(2) " '/^[a-z]/ { split($$1, one, "=="); drops = index(names, " " one[1] " ") } !drops' $(1) > $(1).new && mv $(1).new $(1)

# What a checkout serves with: all that the page and REST offer.
SERVED := --extra exports --extra imports --extra metrics --extra physics --extra video --extra xacro

lock: $(READY_DEV) ## pin the newest versions that pyproject.toml allows
	$(PIP) install pip-tools
	$(COMPILE) --build-deps-for editable --extra test --output-file requirements-dev.txt pyproject.toml
	$(COMPILE) --build-deps-for editable --constraint requirements-dev.txt $(SERVED) --output-file requirements.txt pyproject.toml
	$(COMPILE) --build-deps-for editable --constraint requirements-dev.txt --extra bench --output-file requirements-bench.txt pyproject.toml
	$(call leave-out,requirements-dev.txt,$(UNUSED))
	$(call leave-out,requirements.txt,$(UNUSED_BESIDE_TESTS))
	$(call leave-out,requirements-bench.txt,$(UNUSED_BESIDE_TESTS))
	@printf '%s\n' 'mkdocs>=1.6,<2' 'mkdocs-material>=9.7' 'mkdocstrings[python]>=0.29' | \
	    $(COMPILE) --constraint requirements-dev.txt --output-file requirements-docs.txt -
	@PATH="$(CURDIR)/$(BIN):$$PATH" && cd tests/js && rm -rf package-lock.json node_modules && npm install --package-lock-only \
	    --omit-lockfile-registry-resolved --ignore-scripts --no-audit --no-fund --loglevel=error

clean: ## remove the virtual environment and all that was generated
	rm -rf $(VENV) tests/js/node_modules tests/js/api.d.ts tests/js/openapi.json .mypy_cache .ruff_cache .pytest_cache .hypothesis bench/out dist site
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

$(BIN)/python:
	@for python in $(PYTHON) python3 python3.14 python3.13 python3.12 python3.11 python; do \
	    "$$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))' >/dev/null 2>&1 || continue; \
	    "$$python" -m venv --clear $(VENV) && exit 0; \
	    rm -rf $(VENV); \
	    echo "$$python cannot make virtual environments (on Debian: apt-get install python3-venv)" >&2; exit 1; \
	done; \
	echo "Pleat needs Python 3.11 or newer; if it has another name: make PYTHON=/path/to/python" >&2; exit 1

$(READY): requirements.txt pyproject.toml | $(BIN)/python
	@echo "Installing what Pleat needs into $(VENV): 2 GB, a minute or more (once)"
	@$(BIN)/python -m pip --disable-pip-version-check install --no-compile $(PINNED) requirements.txt
	@$(INSTALL) --no-deps --no-build-isolation -e .
	@touch $@

# So that the first plan does not wait for the compiler, nor several tests at once for the same. A minute or two; seconds
# where it has been done. The arms of one robot are in closed form, those of the other are mapped: few kernels are both's.
# Two processes share the work, each from its own end. The server compiles what is missing behind its first page.
$(KERNELS): $(VENV)/.kernels-%: $(READY) $(shell find planner -name '*.py')
	@echo "Compiling what plans for $*: a minute or two on two cores (once)"
	@$(BIN)/python -m planner.planning.warm_up $* backwards & $(BIN)/python -m planner.planning.warm_up $* && wait $$!
	@touch $@

$(READY_DEV): requirements-dev.txt $(READY)
	@echo "Setting up the tools for tests"
	@$(INSTALL) $(PINNED) requirements-dev.txt
	@touch $@

# Scripts of packages are not run: none of these needs one.
$(READY_JS): tests/js/package-lock.json $(READY_DEV)
	@echo "Setting up the tools for the page's types"
	@PATH="$(CURDIR)/$(BIN):$$PATH" && cd tests/js && npm ci --ignore-scripts --no-audit --no-fund --loglevel=error
	@touch $@

$(READY_DOCS): requirements-docs.txt $(READY_DEV)
	@echo "Setting up what makes the site"
	@$(INSTALL) --require-hashes -r requirements-docs.txt
	@touch $@

# What Pleat is compared with. Only the benchmark wants it, and does without where there is no wheel for this machine.
$(READY_BENCH): requirements-bench.txt $(READY)
	@echo "Setting up what Pleat is compared with"
	@if $(INSTALL) --only-binary :all: $(PINNED) requirements-bench.txt; then touch $@; \
	else echo "Left out: what Pleat is compared with cannot be installed here"; fi
