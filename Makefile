# SPDX-License-Identifier: GPL-3.0-or-later
PYTHON ?= python3
VENV := .tools/python-5.2/bin/python

.PHONY: help setup demo test test-all test-core test-long test-window mutate same-seas lint bench bench-smoke build release docs site guide papers clean

help:       ## this list
	@grep -E '^[a-z-]+: .*##' $(MAKEFILE_LIST) | sed -E 's/:[^#]*##/\t/' | expand -t 14

setup:      ## everything the other targets need, into .tools/ (made once)
	@$(PYTHON) -m tools.setup

demo:       ## bake, build and render the storm of examples/storm.json into build/demo/
	@$(PYTHON) -m tools.setup python-5.2 blender
	@$(VENV) -m tools.demo

test: setup ## every test once, and in each Blender, the installed zip's too, what can differ there
	@$(VENV) -m tools.run_tests

test-all: setup ## every test in every Blender
	@$(VENV) -m tools.run_tests --all

test-core:  ## the tests of the core alone
	@$(PYTHON) -m tools.setup python-5.2
	@$(VENV) -m pytest -q tests/core

test-long:  ## the tests of bakes, ten times as many kills, shared folders, 500 random seas, 300 keyed shots, 1,000 random edits, a session of 2,000 frames, 20,000 damaged files of each kind, and a storm in both engines
	@$(PYTHON) -m tools.setup python-5.2
	@OCEAN_TWEAK_LONG_TESTS=1 $(VENV) -m pytest -q tests/batch tests/blender/test_keyed_shots.py tests/blender/test_random_edits.py tests/blender/test_scene_operators.py tests/blender/test_kept_memory.py tests/core/test_properties.py tests/core/test_cascade_plan.py

test-window: ## the tests in a real Blender's window, by mouse and keyboard; wants a machine that is quiet
	@$(PYTHON) -m tools.setup
	@$(VENV) -m pytest -q tests/ui

guide:      ## follow docs/first-sea.md and docs/ship.md in a real Blender's window, and renew their pictures
	@$(PYTHON) -m tools.setup
	@$(VENV) -m tools.guide

mutate:     ## change constants, formulas and operators of the core and see which test notices (not part of `test`)
	@$(PYTHON) -m tools.setup python-5.2
	@$(VENV) -m tools.mutate

same-seas:  ## whether the seas are those of the commit BASE, bit for bit
	@$(PYTHON) -m tools.setup python-5.2
	@$(VENV) -m tools.same_seas $(or $(BASE),HEAD)

lint:       ## formatting, lint, types of the core, import layers, spelling, wordings; FIX=1 formats first
	@$(PYTHON) -m tools.setup python-5.2
	@$(VENV) -m tools.lint

bench:      ## measure against the targets on a quiet machine; renews docs/performance.md
	@$(PYTHON) -m tools.setup python-5.2 blender
	@$(VENV) -m benchmarks

bench-smoke: ## see that every measurement runs (under a minute; judges no time)
	@$(PYTHON) -m tools.setup python-5.2
	@$(VENV) -m benchmarks --smoke

build:      ## the extension's zip, into build/
	@$(PYTHON) -m tools.setup python-5.2 blender
	@$(VENV) -m tools.build

release:    ## what is published: one zip for all platforms, one for each, and notes, into build/release/; checks them [WEBSITE=https://…]
	@$(PYTHON) -m tools.setup python-5.2 blender
	@$(VENV) -m tools.release $(if $(WEBSITE),--website '$(WEBSITE)')

docs:       ## write the documentation that is made from the code, and build the site into build/site/
	@$(PYTHON) -m tools.setup python-5.2
	@$(VENV) -m tools.parameters_doc
	@$(VENV) -m tools.architecture
	@$(VENV) -m tools.website

site:       ## build the site into build/site/ from the documents as they are
	@$(PYTHON) -m tools.setup python-5.2
	@$(VENV) -m tools.website

papers:     ## make the tables and pictures of docs/papers anew (some minutes)
	@$(PYTHON) -m tools.setup python-5.2
	@$(VENV) -m tools.papers

clean:      ## remove what was made, except .tools/
	rm -rf build wheels .pytest_cache .mypy_cache .ruff_cache .hypothesis .import_linter_cache
	find . -name __pycache__ -not -path './.tools/*' -prune -exec rm -rf {} +
