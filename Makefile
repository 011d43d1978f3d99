# Set-up and everyday commands. `make report` and `make test` need git, make, a C compiler and Python 3; nothing else.
# Every path is relative, so that a clone works wherever it lies.

SHELL := /bin/bash
.SHELLFLAGS := -eu -o pipefail -c
.DEFAULT_GOAL := help
.DELETE_ON_ERROR:

VENV := .venv
TOOLS := .venv-tools
READY := $(VENV)/.ready
PYTHON := $(VENV)/bin/python
PACKAGES := contracts geometry soil reference_fe ancf_reduced rover_dynamics workbench
STUDY ?=
OUT ?= build/report

# Python keeps what it compiled: without that every process compiles every module it imports anew.
unexport PYTHONDONTWRITEBYTECODE
# One thread in BLAS: results repeat, and independent tasks share the cores as processes.
export OMP_NUM_THREADS := 1
# Where we are root and have apt-get, the system's packages are ours to install.
MAY_INSTALL := [ "$$(id -u)" = 0 ] && command -v apt-get >/dev/null
APT := DEBIAN_FRONTEND=noninteractive apt-get --quiet --quiet --yes --no-install-recommends

# Certificates of the machine, not uv's own list: works behind a company's proxy too.
export UV_SYSTEM_CERTS ?= true

.PHONY: help setup report test suite test-long search sample mission docs lint unit evidence bench test-debian test-bare clean distclean

help: ## show this list
	@grep -hE '^[a-z-]+:.*## ' Makefile | sed -E 's/^([a-z-]+):.*## /  make \1\t/' | expand -t 18

setup: $(READY) ## install the pinned environment (the other targets do it when needed)

report: $(READY) ## compute the study and write the report (STUDY=file.toml, OUT=build/report)
	$(VENV)/bin/workbench report $(if $(STUDY),"$(STUDY)") --out "$(OUT)"

test: $(READY) ## lint, and beside it every test in two processes
	$(MAKE) --no-print-directory --jobs=2 lint suite

suite: $(READY)
	$(PYTHON) -m pytest -n 2 --dist loadfile --no-loadscope-reorder --durations 120 --durations-min 3

test-long: $(READY) ## what takes minutes: kills, fuzz, whole studies; the result goes into docs/test_long.json and .md
	$(PYTHON) -m tests.long_run

search: $(READY) ## look for the wheels the thesis' words allow (half an hour; goes on where it stopped); keeps set and table
	$(PYTHON) -m workbench.questions.words.readings studies/thesis_tires
	$(VENV)/bin/workbench sweep studies/words_search.toml --out build/words_search
	$(PYTHON) -m workbench.questions.words.keeping build/words_search studies/words_search.csv

sample: $(READY) ## how the curves vary with what is not exactly known of the wheel (STUDY=file.toml; goes on where it stopped)
	$(VENV)/bin/workbench sample $(if $(STUDY),"$(STUDY)")

mission: $(READY) ## what each requirement of the mission takes on each kind of tire; half an hour, for the report (STUDY=file.toml)
	$(VENV)/bin/workbench mission $(if $(STUDY),"$(STUDY)")

docs: $(READY) ## the manual, build/site/index.html; strict: no warning, no broken link
	NO_MKDOCS_2_WARNING=1 $(VENV)/bin/mkdocs build --site-dir build/site
	@echo "manual: build/site/index.html"

lint: $(READY) ## ruff (rules and format) and mypy --strict
	$(PYTHON) -m ruff check .
	$(PYTHON) -m ruff format --check .
	$(PYTHON) -m mypy --strict $(addprefix -p ,$(PACKAGES))

unit: $(READY) ## the fast tests
	$(PYTHON) -m pytest -q tests/unit

evidence: $(READY) ## docs/evidence.md from the last report (OUT=build/report): claim, test, last value
	$(PYTHON) -m workbench.report.evidence_document "$(OUT)/summary.json" docs/evidence.md tests/data/shipped_checks.csv

bench: $(READY) ## run one benchmark: make bench NAME=fe_wheel [ARGS="--only wheel-60k"]
	@test -n "$(NAME)" || { echo "make bench: NAME is not given; one of:" $(basename $(notdir $(wildcard benchmarks/*.py))) >&2; exit 2; }
	@test -f "benchmarks/$(NAME).py" || { echo "make bench: benchmarks/$(NAME).py is not there; one of:" $(basename $(notdir $(wildcard benchmarks/*.py))) >&2; exit 2; }
	@uv="$$(command -v uv || echo $(TOOLS)/bin/uv)"; \
	"$$uv" pip install --quiet --python $(PYTHON) --constraints constraints.txt --group bench \
	  || echo "make bench: the codes to compare with could not be installed; their columns stay empty" >&2
	$(PYTHON) "benchmarks/$(NAME).py" $(ARGS)

test-debian: $(READY) ## FE tests and a wheel curve on Debian's DOLFINx, 13 and unstable (needs root and debootstrap)
	mkdir -p build/debian
	$(PYTHON) tests/debian/wheel_curve.py build/debian/wheel_build.csv
	tests/debian/run.sh

test-bare: ## the README's commands on a Debian 13 with git, make, gcc and python3 alone (needs root and debootstrap)
	tests/debian/bare.sh

clean: ## remove results and caches, keep the environment
	rm -rf build .mypy_cache .ruff_cache .pytest_cache .hypothesis

distclean: clean ## remove the environment too
	rm -rf $(VENV) $(TOOLS)

# The environment: uv from PATH, or our own copy; Python 3.12, else 3.13, else 3.12 fetched by uv; the exact versions of
# constraints.txt; then doctor tries what was installed. What the system lacks is installed if we may, else named.
$(READY): constraints.txt pyproject.toml .python-version
	@uv="$$(command -v uv || true)"; \
	if [ -z "$$uv" ] && [ ! -x $(TOOLS)/bin/uv ]; then \
	  echo "uv is not on PATH: installing it into $(TOOLS)"; \
	  if ! python3 -c 'import ensurepip' 2>/dev/null; then \
	    packages="python3-venv ca-certificates"; \
	    $(MAY_INSTALL) || { echo "make: python3 has no venv; as root: apt-get install --yes $$packages" >&2; exit 2; }; \
	    $(APT) update && $(APT) install $$packages; \
	  fi; \
	  here="$$PWD"; \
	  (cd / && python3 -m venv "$$here/$(TOOLS)" && "$$here/$(TOOLS)/bin/python" -m pip install --quiet --disable-pip-version-check uv) \
	    || { rm -rf $(TOOLS); echo "make: uv could not be installed with python3; install uv yourself and put it on PATH" >&2; exit 2; }; \
	fi; \
	uv="$${uv:-$(TOOLS)/bin/uv}"; \
	if ! $(PYTHON) -c 'import sys; sys.exit(sys.version_info[:2] not in ((3, 12), (3, 13)))' 2>/dev/null; then \
	  find="$$uv python find --no-project --no-python-downloads"; \
	  found="$$($$find "$$(cat .python-version)" 2>/dev/null || $$find 3.13 2>/dev/null || cat .python-version)"; \
	  "$$uv" venv --quiet --clear --python "$$found" $(VENV); \
	fi; \
	"$$uv" pip install --quiet --python $(PYTHON) --constraints constraints.txt --build-constraints constraints.txt --group dev --group docs --editable . ; \
	echo "trying what was installed (workbench doctor)"; \
	$(VENV)/bin/workbench doctor $$($(MAY_INSTALL) && echo --install) > $(VENV)/doctor.txt 2>&1 || { cat $(VENV)/doctor.txt >&2; exit 2; }; \
	touch $@
