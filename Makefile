# Each target sets up what it needs; none needs more than Python 3.11 or newer, make, git and a C compiler.

PYTHON ?= $(shell command -v python3.11 || command -v python3.12 || command -v python3.13 || command -v python3.14 || command -v python3)
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
KERNEL8 := .venv-kernel8
PART ?= examples/freeform.step
OUT ?= out/demo

# Python's code is kept: without it each of the hundreds of processes that the tests start reads all sources anew.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: setup wheel release site demo test tests tests-kernel8 test-all lint bench docs clean

setup: $(STAMP)

# Running from the clone (editable), with everything that tests and examples need.
$(STAMP): setup.cfg pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or newer is needed: make setup PYTHON=...")'
	@test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e '.[test]'
	@touch $(STAMP)

wheel: setup
	$(BIN)/python -m pip wheel --quiet --disable-pip-version-check --no-deps --no-build-isolation --wheel-dir dist .

# Archives, recipe and entries, checked; the wheel is tried in clean environments of these (make release PYTHONS="python3.11 python3.14").
PYTHONS ?= $(BIN)/python
release: setup
	$(BIN)/python resources/release/release.py dist $(foreach python,$(PYTHONS),--python $(abspath $(shell command -v $(python))))

demo: setup
	$(BIN)/toolaxis plan $(PART) --tool torus-12x1 --scallop 0.02 --out $(OUT)
	$(BIN)/toolaxis verify $(OUT)

lint: setup
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	cd workbench && ../$(BIN)/lint-imports

test: lint tests

tests: setup
	$(BIN)/python -m pytest -n 4 --dist loadfile --no-loadscope-reorder --durations 40

# What hands shapes to the CAD kernel and takes them from it once more, on its release 8, and the wheel's main job.
ON_KERNEL8 := $(patsubst %,tests/cad/test_%.py,kernel_agreement adapters bad_files loose_shells machine_bodies) \
              tests/job/test_exporting.py tests/test_wheel.py::test_the_demo_does_the_main_job_from_the_wheel

$(KERNEL8)/.installed: setup.cfg pyproject.toml
	@test -x $(KERNEL8)/bin/python || $(PYTHON) -m venv $(KERNEL8)
	$(KERNEL8)/bin/python -m pip install --quiet --disable-pip-version-check -e '.[test-kernel8]'
	@touch $@

tests-kernel8: $(KERNEL8)/.installed
	$(KERNEL8)/bin/python -m pytest -n 2 --dist loadfile $(ON_KERNEL8)

test-all: lint
	$(BIN)/python -m pytest -n 4 --dist loadfile --no-loadscope-reorder --long

bench: setup
	$(BIN)/python -m benchmarks

# The manual as a site in out/site; what it takes is installed when it is asked for.
SITE := .venv-site

$(SITE)/.installed: resources/site/requirements.txt
	@test -x $(SITE)/bin/python || $(PYTHON) -m venv $(SITE)
	$(SITE)/bin/python -m pip install --quiet --disable-pip-version-check -r $<
	@touch $@

site: $(SITE)/.installed
	rm -rf out/site
	$(SITE)/bin/sphinx-build -q -E -W --keep-going -d out/site-read -c resources/site resources/manual out/site

docs: setup
	$(BIN)/python resources/manual/figures.py

clean:
	rm -rf out build dist core/*.egg-info .mypy_cache .ruff_cache .pytest_cache .import_linter_cache workbench/.import_linter_cache
	find core tests benchmarks examples -name __pycache__ -prune -exec rm -rf {} +
