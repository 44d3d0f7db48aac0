# wheelrail: `make demo` shows what it does, `make test` checks it. Both do all set-up in a fresh clone.
#
#   make fmu     target/WheelRailContact.fmu
#   make demo    the paper's cases and a braking manoeuvre through FMPy: results/
#   make couplings  the component in vehicle models, masters and sweeps: results/, one page each in docs/couplings/
#   make test    formatting, lints, documentation, all Rust tests, `wheelrail verify`, all Python tests
#   make docs    the generated tables and pictures of README.md and of the documentation
#   make site    the documentation as a site: target/site/index.html
#   make bench   run times: a step, a cold start, saving; against the number of contact nodes and the targets
#   make clean   removes everything that the above made

SHELL := /bin/bash
.SHELLFLAGS := -eu -o pipefail -c
.DEFAULT_GOAL := fmu

PYTHON ?= python3
VENV := .venv
PY := $(CURDIR)/$(VENV)/bin/python
# One place for everything built, whatever the environment says.
export CARGO_TARGET_DIR := $(CURDIR)/target
# The scripts are vectorised over small arrays: threads of their own would only get in each other's way.
export OMP_NUM_THREADS := 1
export OPENBLAS_NUM_THREADS := 1
export MPLBACKEND := Agg

FMU := target/WheelRailContact.fmu
WHEELRAIL := target/release/wheelrail
# The shared library of a Linux FMU is linked against the symbols of glibc 2.17 (2012), by zig as the linker.
PORTABLE := x86_64-unknown-linux-gnu
GLIBC := 2.17

say = @printf '\n\033[1m== %s\033[0m\n' '$(1)'

COUPLINGS := longitudinal stiff multibody train sweep
WHEELSET := target/Wheelset.fmu

.PHONY: fmu demo test docs site bench clean lint rust-test verify python-test hosts library command couplings
.PHONY: couplings-set-up couplings-docs sweep-scaling $(addprefix coupling-,$(COUPLINGS))

# ---- set-up -------------------------------------------------------------------------------------------------------

$(VENV)/ready: requirements.txt
	$(call say,Python environment $(VENV))
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or newer is needed, this is " + sys.version)'
	$(PYTHON) -m venv $(VENV)
	$(PY) -m pip install --quiet --disable-pip-version-check -r requirements.txt
	@touch $@

$(VENV)/couplings: requirements-couplings.txt $(VENV)/ready
	$(call say,Packages for the couplings)
	$(PY) -m pip install --quiet --disable-pip-version-check -r requirements-couplings.txt
	@touch $@

$(VENV)/site: requirements-site.txt $(VENV)/ready
	$(call say,Packages for the documentation site)
	$(PY) -m pip install --quiet --disable-pip-version-check -r requirements-site.txt
	@touch $@

# Hosts that need more than a Python package: each has a test that is skipped, with the reason, where this fails.
hosts: $(VENV)/ready
	$(call say,Other simulation hosts)
	@$(PY) tools/hosts.py

# ---- the component ------------------------------------------------------------------------------------------------

command:
	$(call say,Command line $(WHEELRAIL))
	cargo build --release --bin wheelrail

library: $(VENV)/ready
	$(call say,Shared library)
	@$(PY) tools/build_library.py --target $(PORTABLE) --glibc $(GLIBC)

fmu: library command
	$(call say,$(FMU))
	@$(WHEELRAIL) pack --library "$$(cat target/library.path)" --output $(FMU)

# ---- what it does -------------------------------------------------------------------------------------------------

demo: fmu
	$(call say,The cases of the paper)
	@$(PY) examples/paper_cases.py
	$(call say,A braking manoeuvre)
	@$(PY) examples/braking_demo.py
	$(call say,Written)
	@ls -l results/*.csv results/*.png | awk '{ print $$NF, "(" $$5, "bytes)" }'

# ---- couplings: `make couplings` or one of them, `make coupling-stiff` for example --------------------------------

$(WHEELSET): examples/wheelset.py $(VENV)/couplings
	@$(PY) -m pythonfmu build -f examples/wheelset.py -d target

couplings-set-up: fmu hosts $(VENV)/couplings $(WHEELSET)

couplings: $(addprefix coupling-,$(COUPLINGS))

$(addprefix coupling-,$(COUPLINGS)): coupling-%: couplings-set-up
	$(call say,Coupling: $*)
	@$(PY) examples/$*.py

# The pictures of the pages in docs/couplings/; commit what changes.
couplings-docs: couplings
	@cp results/longitudinal.png results/stiff.png results/multibody.png results/train.png results/creep_curves.png docs/couplings/

# The time that the sweep takes on two workers against one.
sweep-scaling: couplings-set-up
	@$(PY) examples/sweep.py --scaling

# ---- checks -------------------------------------------------------------------------------------------------------

test: lint rust-test verify python-test
	$(call say,All checks passed)

lint: $(VENV)/ready
	$(call say,Formatting - lints - documentation)
	cargo fmt --check
	cargo clippy --quiet --all-targets -- -D warnings
	RUSTDOCFLAGS='-D warnings' cargo doc --quiet --no-deps
	$(VENV)/bin/ruff check .
	$(VENV)/bin/ruff format --check .

rust-test:
	$(call say,Rust tests)
	cargo test --no-fail-fast

verify: command
	$(call say,Verification against closed forms and the paper)
	$(WHEELRAIL) verify

python-test: fmu hosts couplings-set-up $(VENV)/site
	$(call say,Python tests)
	$(PY) -m pytest

# README's and the documentation page's generated tables, README's pictures and those of the verification; commit what
# changes.
docs: demo
	@$(PY) tools/update_docs.py
	@$(PY) tools/verification_figures.py
	@cp results/paper_temperature.png results/braking.png docs/
	@cp results/verification/*.png docs/verification/

# The site needs no network when it is read; warnings are errors.
site: command $(VENV)/site
	$(call say,Documentation)
	@$(PY) tools/build_site.py

bench: $(VENV)/ready
	cargo bench
	@$(PY) tools/scaling_figure.py

clean:
	rm -rf target $(VENV) .venv-cofmupy results .pytest_cache .ruff_cache
