# Set-up, the main job, tests and checks. Needs Python >= 3.11 and a C++17 compiler; the rest comes from PyPI into .venv.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
# In .venv once and for all, so that building again compiles only what changed.
BUILDERS := 'scikit-build-core>=0.10' 'nanobind>=2.2' cmake ninja
INSTALL := $(BIN)/python -m pip install --quiet --no-build-isolation --editable
SOURCES := pyproject.toml CMakeLists.txt $(wildcard core/*.hpp core/*.cpp)

.PHONY: demo test slow lint format wheel picture clean

demo: $(VENV)/.installed  ## solve the built-in two-tube robot and draw it
	@mkdir -p out
	$(BIN)/tactr solve --plot out/two_tube.png

test: $(VENV)/.installed  ## all tests but the slow ones and the studies
	$(BIN)/python -m pytest -m "not slow and not study"

slow: $(VENV)/.installed  ## the slow tests
	$(BIN)/python -m pytest -m "slow and not study"

lint: $(VENV)/.checkers
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/pyright

format: $(VENV)/.checkers
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

wheel: $(VENV)/.installed
	rm -rf dist
	$(BIN)/python -m pip wheel --quiet --no-deps --no-build-isolation --wheel-dir dist .

picture: $(VENV)/.installed  ## the picture in the README
	$(BIN)/tactr solve --plot docs/two_tube.png

clean:
	rm -rf $(VENV) build dist out

$(VENV)/.installed: $(SOURCES)
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "tactr needs Python 3.11 or newer: make PYTHON=python3.12 ...")'
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet $(BUILDERS)
	$(INSTALL) '.[test]'
	@touch $@

$(VENV)/.checkers: $(VENV)/.installed
	$(INSTALL) '.[dev]'
	@touch $@
