# Needs Python 3.11 with pip, and make; everything else is installed, into .venv.
SHELL := /bin/bash
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
PYTHON ?= $(firstword $(shell command -v python3.11) $(shell command -v python3))
WORKERS ?= 2

export PIP_DISABLE_PIP_VERSION_CHECK := 1

.PHONY: demo test slow lint docs picture bench install clean

demo: install
	$(BIN)/showtell demo

test: lint
	@$(PYTHON) tools/system_libraries.py --tests
	$(BIN)/python -m pytest -n $(WORKERS)

slow: install
	$(BIN)/python -m pytest -m slow -n $(WORKERS)

lint: install
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

# A site in build/docs; a warning, such as a link to nowhere, is an error.
docs: install
	$(BIN)/python -m sphinx -b html -c docs -d build/doctrees --fail-on-warning --keep-going -q . build/docs
	@echo "open build/docs/docs/index.html"

# docs/showtell.gif and docs/page.png: the way on the page, in Chromium, with what `make demo` learned.
picture: install
	@test -f demo-out/knowledge.json || $(BIN)/showtell demo
	$(BIN)/python -m tests.pictures demo-out/knowledge.json

bench: install
	rm -rf build/bench
	$(BIN)/showtell record --device scripted --count 5 --jobs 1 --seed 0 -o build/bench

install: $(STAMP)

# A second run finds the stamp newer than what it depends on, and installs nothing.
$(STAMP): pyproject.toml constraints.txt tools/system_libraries.py
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info[:2] != (3, 11))' 2>/dev/null || \
		{ echo "Showtell needs Python 3.11, found '$(PYTHON)': install it, or run 'make PYTHON=/path/to/python3.11 $(MAKECMDGOALS)'" >&2; exit 1; }
	@$(PYTHON) tools/system_libraries.py
	@test -x $(BIN)/python || $(PYTHON) -m venv $(VENV) || \
		{ echo "No virtual environment could be made; on Debian run: sudo apt-get install -y python3.11-venv" >&2; exit 1; }
	@echo "Installing Showtell into $(VENV): one to three minutes the first time"
	@$(BIN)/python -m pip install --quiet --no-input -c constraints.txt -e '.[dev]'
	@touch $@

clean:
	rm -rf $(VENV) build dist demo-out *.egg-info .mypy_cache .ruff_cache .pytest_cache .import_linter_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
