# wheelrail: `make demo` shows what it does, `make test` checks it. Both do all set-up in a fresh clone.
#
#   make fmu     target/WheelRailContact.fmu
#   make fmu3    target/WheelRailContact-fmi3.fmu, the same library under FMI 3.0
#   make platforms  win64 in the same archive, and aarch64 Linux: built where there is a compiler, run under wine and qemu
#   make wheel   dist/wheelrail-*.whl: a Python package with the FMUs and the command line in it
#   make demo    the paper's cases, a braking manoeuvre, the patch and profiles: results/
#   make measurements  fits to measured creep curves, a twin disc, wear: results/ and docs/measurements.md
#   make couplings  the component in vehicle models, masters and sweeps: results/, one page each in docs/couplings/
#   make test    formatting, lints, order of the modules, documentation, all Rust tests, `wheelrail verify`, all Python tests
#   make test-debug  the Rust tests in the debug build: overflow and debug assertions are checked
#   make soak [MINUTES=60] [SEED=7]  random tests drawn anew, round after round; a seed draws one of them again
#   make derivatives [CASES=2000]  derivatives of random steps against differences, so many for each contact and law of friction
#   make bits BEFORE=<revision>  what the component computes, to the bit, against that of another revision of git
#   make description  the XML files in modelDescription/, after a change of a variable
#   make docs    the generated tables and pictures of README.md and of the documentation
#   make site    the documentation as a site: target/site/index.html
#   make bench   run times: a step, a cold start, saving; against the number of contact nodes and the targets
#   make bench-check  iterations of a step on the rough track against recorded ones, whatever the machine
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
# Python keeps what it has compiled of a package, also where the environment forbids it, as images of containers do: else
# each of the tests' many processes would compile pandas and Matplotlib anew, five seconds of a processor.
unexport PYTHONDONTWRITEBYTECODE

FMU := target/WheelRailContact.fmu
FMU3 := target/WheelRailContact-fmi3.fmu
WHEELRAIL := target/release/wheelrail
# Everything is compiled once, in one profile for one target, and linked by zig against the symbols of glibc 2.17 (2012):
# the library that the FMU takes along, the command line, and the tests. tools/cargo.py says how.
PORTABLE := x86_64-unknown-linux-gnu
GLIBC := 2.17
CARGO := $(PY) tools/cargo.py --target $(PORTABLE) --glibc $(GLIBC)
# Two things side by side, unless -j says how many.
BESIDE = $(MAKE) --no-print-directory $(if $(findstring -j,$(MAKEFLAGS)),,-j2)

say = @printf '\n\033[1m== %s\033[0m\n' '$(1)'
# uv takes a fifth of pip's time; where it fails, pip may know better what mirror to ask.
install = $(PY) -m uv pip install --quiet --python $(PY) -r $(1) \
	|| $(PY) -m pip install --quiet --disable-pip-version-check -r $(1)

COUPLINGS := longitudinal stiff multibody train sweep hunting adhesion maintenance height curve mileage
WHEELSET := target/Wheelset.fmu

.PHONY: fmu fmu3 platforms wheel demo measurements measurements-docs test test-debug soak derivatives bits docs site bench bench-check clean lint lint-sources lint-compiled rust-test verify python-test hosts library command couplings packages
.PHONY: pytest couplings-set-up couplings-docs sweep-scaling description $(addprefix coupling-,$(COUPLINGS))

# ---- set-up -------------------------------------------------------------------------------------------------------

# What cargo needs to link. The rest is installed while it compiles.
$(VENV)/build: requirements-build.txt
	$(call say,Python environment $(VENV))
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or newer is needed, this is " + sys.version)'
	$(PYTHON) -m venv $(VENV)
	$(PY) -m pip install --quiet --disable-pip-version-check --no-compile -r requirements-build.txt
	@touch $@

$(VENV)/ready: requirements.txt $(VENV)/build
	$(call say,Packages for the examples and the tests)
	$(call install,requirements.txt)
	@touch $@

$(VENV)/couplings: requirements-couplings.txt $(VENV)/ready
	$(call say,Packages for the couplings and some hosts)
	$(call install,requirements-couplings.txt)
	@touch $@

# After those of the couplings: one environment takes one installation at a time.
$(VENV)/site: requirements-site.txt $(VENV)/ready | $(VENV)/couplings
	$(call say,Packages for the documentation site)
	$(call install,requirements-site.txt)
	@touch $@

# Hosts that need more than a Python package: each has a test that is skipped, with the reason, where this fails.
hosts: $(VENV)/ready
	$(call say,Other simulation hosts)
	@$(PY) tools/hosts.py

# ---- the component ------------------------------------------------------------------------------------------------

# Both at once, so that the packages that they share are compiled once; `make test` compiles the tests beside them.
library: $(VENV)/build
	$(call say,Shared library and command line)
	@$(CARGO) library $(BESIDE_THE_LIBRARY)

command: library

fmu: library
	$(call say,$(FMU))
	@$(WHEELRAIL) pack --library "$$(cat target/library.path)" $$($(PY) tools/platforms.py --binaries fmi2) --output $(FMU)

# From the same library.
fmu3: library
	$(call say,$(FMU3))
	@$(WHEELRAIL) pack --fmi 3 --library "$$(cat target/library.path)" $$($(PY) tools/platforms.py --binaries fmi3) --output $(FMU3)

# Skips with a reason what cannot be built or run here. Options by PLATFORMS, as in `make platforms PLATFORMS=--twice`.
# What passes is packed, by `make fmu` as well as long as the sources stay as they are.
platforms: fmu
	$(call say,Other platforms)
	@$(PY) tools/platforms.py $(PLATFORMS)
	@$(MAKE) --no-print-directory fmu fmu3

# python/, every FMU that is built, and the command line; the version is that of Cargo.toml. Where `make platforms` has built
# the command line for Windows, one with that; where the FMU has libraries for other platforms, one without is for these.
wheel: fmu fmu3 $(VENV)/ready
	$(call say,Python package)
	@rm -rf dist
	@$(PY) -m hatchling build -t wheel -d dist
	@if [ -n "$$($(PY) tools/platforms.py --command win64)" ]; then WHEELRAIL_WHEEL=win_amd64 $(PY) -m hatchling build -t wheel -d dist; fi
	@if $(PY) -m zipfile -l $(FMU) | grep -o 'binaries/[a-z0-9]*/' | grep -v /linux64/ > /dev/null; then \
	  WHEELRAIL_WHEEL=any $(PY) -m hatchling build -t wheel -d dist; fi

# The description that is checked in; a test compares.
description: command
	$(WHEELRAIL) describe --xml > target/modelDescription.xml
	mv target/modelDescription.xml modelDescription/modelDescription.xml
	$(WHEELRAIL) describe --xml --fmi 3 > target/modelDescription.xml
	mv target/modelDescription.xml modelDescription/fmi3/modelDescription.xml
	$(WHEELRAIL) describe --terminals > target/terminalsAndIcons.xml
	mv target/terminalsAndIcons.xml modelDescription/fmi3/terminalsAndIcons.xml

# ---- what it does -------------------------------------------------------------------------------------------------

demo:
	+@$(BESIDE) fmu fmu3 $(VENV)/ready
	$(call say,The cases of the paper)
	@$(PY) studies paper_cases
	$(call say,A braking manoeuvre - a stop)
	@$(PY) studies braking_demo
	$(call say,The patch: its fields)
	@$(PY) studies patch_fields
	$(call say,The patch: creep curves beside CONTACT and FASTSIM)
	@$(CARGO) run --quiet --example patch_creep_curves > results/patch_creep_curves.part
	@mv results/patch_creep_curves.part results/patch_creep_curves.csv
	@$(PY) studies patch_creep_curves
	$(call say,Profiles: where they touch and the pressure there)
	@$(PY) studies profiles_contact
	$(call say,Profiles: two wheels of a wheelset over its displacement)
	@$(PY) studies wheelset_sweep
	@cp $(FMU) results/
	$(call say,Written)
	@ls -l results/*.fmu results/*.csv results/*.png | awk '{ print $$NF, "(" $$5, "bytes)" }'

# SciPy comes with the packages of the couplings.
measurements: fmu $(VENV)/couplings
	$(call say,The Eurosprinter: friction and layer fitted to a measured creep curve)
	@$(PY) studies eurosprinter
	$(call say,A twin disc: friction - temperatures - wear)
	@$(PY) studies twin_disc

# The pictures and tables of docs/measurements.md; commit what changes.
measurements-docs: measurements
	@$(PY) tools/update_docs.py measurements
	@cp results/eurosprinter.png results/twin_disc.png results/wear_branches.png docs/measurements/

# ---- couplings: `make couplings` or one of them, `make coupling-stiff` for example --------------------------------

$(WHEELSET): studies/longitudinal/wheelset.py $(VENV)/couplings
	@$(PY) -m pythonfmu build -f studies/longitudinal/wheelset.py -d target

couplings-set-up: fmu fmu3 hosts $(WHEELSET)

couplings: $(addprefix coupling-,$(COUPLINGS))

$(addprefix coupling-,$(COUPLINGS)): coupling-%: couplings-set-up
	$(call say,Coupling: $*)
	@$(PY) studies $*

MILEAGE := $(addprefix mileage_,$(addsuffix .png,profiles depths plain plain_profiles plain_measures measures curves laws))
HUNTING := $(addsuffix .png,hunting_stability hunting_cycle hunting_curve hunting_contact)

# The pictures of the pages in docs/couplings/, and their tables where they are generated; commit what changes.
couplings-docs: couplings
	@$(PY) tools/update_docs.py couplings
	@cp $(addprefix results/,longitudinal.png stiff.png stiff_stop.png multibody.png train.png creep_curves.png $(HUNTING) adhesion.png maintenance.png height.png curve.png curve_above.png $(MILEAGE)) docs/couplings/

# The time that the sweep takes on two workers against one.
sweep-scaling: couplings-set-up
	@$(PY) studies sweep --scaling

# ---- checks -------------------------------------------------------------------------------------------------------

# First what the checks need, compiled and downloaded side by side, and what can be checked without it; then the checks that
# use it, each with its output in one piece. These take what is built for granted (-o). The tests are compiled with the
# library, as one core would wait for it otherwise.
test:
	+@$(BESIDE) BESIDE_THE_LIBRARY=--tests fmu fmu3 packages lint-sources
	$(call say,Rust tests - Python tests - lints: each is printed as it ends)
	+@$(BESIDE) -o library -o fmu -o fmu3 -o packages --output-sync=target --keep-going rust-test python-test lint-compiled
	$(call say,All checks passed)

packages: couplings-set-up $(VENV)/site

lint: lint-sources lint-compiled

lint-sources: $(VENV)/ready
	$(call say,Formatting - order of the modules - Python)
	cargo fmt --check
	$(PY) tools/layers.py
	$(PY) tools/doc_comments.py
	$(VENV)/bin/ruff check .
	$(VENV)/bin/ruff format --check .
	$(VENV)/bin/mypy

lint-compiled: $(VENV)/build
	$(call say,Lints - documentation)
	$(CARGO) clippy --quiet --all-targets -- -D warnings
	RUSTDOCFLAGS='-D warnings' $(CARGO) doc --quiet --no-deps

# Without the checks of the verification, one test each: `verify` has gone through the same. Examples are not linked as programs:
# tests/examples.rs has three of them in it, and clippy compiles all. The tests of the documentation cargo runs apart from others.
rust-test: $(VENV)/build
	$(call say,Rust tests)
	$(CARGO) test --no-fail-fast --tests -- --skip 'verify: '
	$(CARGO) test --doc

# What a release build leaves out: overflow of integers, debug assertions.
test-debug:
	$(call say,Rust tests in the debug build)
	cargo test --locked --no-fail-fast

# Not a part of `make test`, whose verdict is the same in every run.
soak: fmu fmu3 $(VENV)/ready
	$(call say,Random tests - new in every round)
	@$(PY) tools/soak.py $(if $(MINUTES),--minutes $(MINUTES)) $(if $(SEED),--seed $(SEED)) -- --target $(PORTABLE) --glibc $(GLIBC)

# Counts of what was compared, of what is at corners that the state names, and of what is at others; PROPTEST_RNG_SEED draws other cases, and
# CASES=1289..1290 compares some of them alone.
derivatives: $(VENV)/build
	$(call say,Derivatives against differences of the step)
	DERIVATIVE_CASES=$(or $(CASES),2000) $(CARGO) test --test model random_sensitivity -- --nocapture

# After a change that is to leave the results as they are. LEAVE_OUT=state where what is saved has changed alone.
bits: fmu $(VENV)/ready
	@: $(or $(BEFORE),$(error which revision of git to compare with: make bits BEFORE=main))
	$(call say,The same bits as $(BEFORE))
	@$(PY) tools/bits.py revision $(BEFORE) $(FMU) $(addprefix --leave-out ,$(LEAVE_OUT)) -- --target $(PORTABLE) --glibc $(GLIBC)

# target/verification.txt is what the tables of the documentation are made of and compared with.
verify: command
	$(call say,Verification against closed forms and the paper)
	@rm -f target/verification.txt
	$(WHEELRAIL) verify | tee target/verification.part
	@mv target/verification.part target/verification.txt

python-test: fmu fmu3 verify packages
	@$(MAKE) --no-print-directory pytest

# Alone it takes what is built for granted. A file at a time to each worker, in the order of python_tests/conftest.py.
pytest:
	$(call say,Python tests)
	$(PY) -m pytest --numprocesses 2 --dist loadfile --no-loadscope-reorder

# README's and the documentation page's generated tables, README's pictures and those of the verification; commit what
# changes.
docs: demo verify
	@$(PY) tools/verification_figures.py
	@$(PY) tools/update_docs.py
	@$(PY) tools/patch_axes.py
	@$(PY) tools/profiles_figure.py
	@$(PY) tools/profiles_axes.py
	@cp results/paper_temperature.png results/braking.png results/braking_stop.png results/patch_fields.png results/patch_creep_curves.png results/profiles_contact.png results/wheelset_sweep.png docs/
	@cp results/verification/*.png docs/verification/

# The site needs no network when it is read; warnings are errors.
site: verify $(VENV)/site
	$(call say,Documentation)
	@$(PY) tools/build_site.py

bench: fmu $(VENV)/ready
	cargo bench
	@$(PY) tools/scaling_figure.py
	@mkdir -p results
	cargo run --release --quiet --example error_over_time > results/error_over_time.part
	@mv results/error_over_time.part results/error_over_time.csv
	@$(PY) studies error_over_time
	@cp results/error_over_time.png docs/
	@$(PY) studies manchester
	@cp results/manchester.png docs/

# Iterations a step on the rough track against recorded ones, which do not hang on the machine; a part of `make test` as well.
bench-check: $(VENV)/build
	$(call say,Iterations on the rough track)
	$(CARGO) test --test model rough_track -- --nocapture

clean:
	rm -rf target dist $(VENV) .venv-cofmupy results .pytest_cache .ruff_cache .mypy_cache
