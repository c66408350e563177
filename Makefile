# Everything starts here: `make run` and `make test` set up what they need first.
# PYTHON=python3.12 chooses the interpreter; ARGS="..." goes on to the program.

SCENARIO ?= manipulation
BIN := .venv/bin
INTERPRETER := $(or $(PYTHON),python3)
SETUP = command -v $(INTERPRETER) >/dev/null || { echo "$(INTERPRETER) is not on the PATH: install Python 3.10-3.13 \
	(sudo apt install python3, brew install python@3.12) or name one, as in PYTHON=python3.12" >&2; exit 1; }; \
	$(INTERPRETER) -I -S tools/environment
CODE := src bringup tests tools $(wildcard benchmarks examples)

# A sourced ROS workspace or another environment must not leak into this one.
unexport PYTHONPATH PYTHONHOME AMENT_PREFIX_PATH CMAKE_PREFIX_PATH COLCON_PREFIX_PATH
unexport _ROS_WHEELS_BOOTSTRAP_COMPLETE
# Container images often forbid it: then each of a run's processes compiles 1,400 files again.
unexport PYTHONDONTWRITEBYTECODE

.DEFAULT_GOAL := help
.PHONY: help setup setup-run run test bench field faults docs figures pictures lint format clean

help: ## show this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / {printf "  make %-9s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

run: setup-run ## set up, then run the manipulation (other scenario: SCENARIO=hover; options: ARGS="--seed 3")
	@$(BIN)/uvms run $(SCENARIO) $(ARGS)

test: setup ## set up, then run all tests (some of them: ARGS="tests/uvms_planner -k cost")
	@$(BIN)/python -m pytest --numprocesses 2 $(ARGS)

bench: setup ## set up, then measure speed and quality, one JSON object a line
	@$(BIN)/python benchmarks/run.py $(ARGS)

field: setup ## set up, then run the trial field (twenty minutes on 2 cores) and write docs/trial-field.md
	@$(BIN)/python -m uvms_bringup.field $(ARGS)

faults: setup ## set up, then run all fault tests, the long ones too, and write their table into docs/faults.md
	@UVMS_FAULTS=long UVMS_FAULTS_TABLE=docs/faults.md $(BIN)/python -m pytest tests/faults $(ARGS)

docs: setup ## set up, then build the documentation as a static site in site/ (open site/index.html)
	@NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --quiet --config-file tools/site/mkdocs.yml
	@echo "The documentation is in site/index.html"

pictures: setup ## set up, then make the viewer's pictures, its movie and what the tour prints again (that alone: ARGS=tour)
	@$(BIN)/python tools/pictures $(ARGS)

figures: setup ## set up, then make the paper's figures and docs/paper-figures.md from runs of ours again
	@$(BIN)/python -m uvms_bringup.paper_figures $(ARGS)

lint: setup ## check style and types
	@$(BIN)/ruff check $(CODE)
	@$(BIN)/ruff format --check $(CODE)
	@$(BIN)/mypy

format: setup ## put the sources into the project's style
	@$(BIN)/ruff check --fix $(CODE)
	@$(BIN)/ruff format $(CODE)

setup: ## set up .venv with the tools for development; does nothing where nothing has changed
	@$(SETUP) --development

setup-run:
	@$(SETUP)

clean: ## remove everything that was made: .venv, runs, caches
	rm -rf .venv runs site build install log .pytest_cache .mypy_cache .ruff_cache .hypothesis .coverage
	find $(CODE) \( -name __pycache__ -o -name '*.egg-info' \) -prune -exec rm -rf {} +
