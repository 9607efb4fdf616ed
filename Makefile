# Everything this project does with one command. `make` alone lists it.
.DEFAULT_GOAL := help
.PHONY: help setup demo test long fresh faults mutation lint types types-win32 types-darwin contracts format wheel clean
BIN := .venv/bin

help:  ## This list
	@sed -n 's/^\([a-z]*\):.*## \(.*\)/  make \1\t\2/p' Makefile

setup: .venv/ready-to-test  ## .venv with all that running and testing needs

demo: .venv/ready-to-run  ## The whole console without hardware: drive, hand over, take back, report
	$(BIN)/simconsole demo

test: setup lint  ## All checks: format, lint, types, import contracts, tests
	scripts/system-packages
	$(BIN)/pytest --numprocesses auto --maxprocesses 4 --dist loadfile --no-loadscope-reorder

long: setup  ## The random and long checks at their full size, with seeds drawn anew: docs/long-run.md; hours
	scripts/system-packages
	$(BIN)/pytest --long --timeout 0 --write-faults --write-long-run --numprocesses 2 --dist worksteal
	scripts/fresh-machine

fresh:  ## `make demo` and `make test` on bare Debian systems, stable and unstable; as root; an hour
	scripts/fresh-machine

faults: setup  ## The fault cases, and what they measured into docs/faults.md; minutes
	scripts/system-packages
	$(BIN)/pytest -m fault --write-faults --numprocesses auto --maxprocesses 4 --dist loadfile

mutation: setup  ## Mutation score of control/ into docs/mutation.md; some minutes on two cores
	$(BIN)/python scripts/mutation.py

lint: .venv/ready-to-test  ## Format, lint, types and import contracts only
	$(BIN)/ruff format --check --quiet
	$(BIN)/ruff check --quiet
	$(MAKE) --no-print-directory --jobs 2 --output-sync types types-win32 types-darwin contracts

types:
	$(BIN)/mypy
	$(BIN)/mypy benchmarks scripts

types-win32 types-darwin: types-%:
	$(BIN)/mypy --platform $* --cache-dir .mypy_cache/$* simconsole

contracts:
	$(BIN)/lint-imports --no-logo

format: .venv/ready-to-test  ## Rewrite the sources in the project's format
	$(BIN)/ruff check --fix
	$(BIN)/ruff format

wheel: .venv/ready-to-test  ## dist/*.whl, profiles included
	$(BIN)/python -m build --wheel --no-isolation

clean:  ## Remove .venv and all that was built
	rm -rf .venv .venv-ros2 build dist out .mypy_cache .ruff_cache .pytest_cache .hypothesis .import_linter_cache

.venv/ready-to-run: pyproject.toml constraints.txt scripts/make-venv
	@scripts/make-venv
	@touch $@

.venv/ready-to-test: pyproject.toml constraints.txt scripts/make-venv scripts/make-ros2-venv
	@scripts/make-venv dev
	@touch $@ .venv/ready-to-run
