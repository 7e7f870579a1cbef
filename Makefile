# Two commands: `make demo` and `make test`. Each makes .venv when it is missing.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
# setuptools warns of every editable installation.
PIP := PYTHONWARNINGS=ignore::UserWarning $(BIN)/python -m pip install --quiet

.PHONY: setup demo test check docs tutorial scale cluster bench verification sensitivity confusion run-up-motion balance contact difficulty faults fuzz bench-set baselines sample adapters zeng2019 zeng2019-fit pictures schemas reference clean

setup: $(VENV)/.installed-dev

demo: $(VENV)/.installed
	$(BIN)/rubgen generate --out out/demo
	$(BIN)/rubgen info out/demo

# One thread of BLAS and OpenMP in each process: pytest starts one for each core, and threads that wait cost its time.
test: $(VENV)/.installed-dev
	OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 $(BIN)/pytest -n auto --dist loadscope --no-loadscope-reorder

check: $(VENV)/.installed-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(MAKE) --no-print-directory docs

# The site, into site/. A link that leads nowhere ends the build.
docs: $(VENV)/.installed-dev
	NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --strict --quiet

# The tutorial, run from its page, as docs/tutorial.ipynb.
tutorial: $(VENV)/.installed-dev
	$(BIN)/python docs/notebook.py

SIZES ?= 100 1000 10000
MACHINES ?= 200
scale: $(VENV)/.installed-dev
	$(BIN)/python -m benchmarks.scale $(SIZES)

cluster: $(VENV)/.installed-dev
	$(BIN)/python -m validation.cluster --machines $(MACHINES)

bench: $(VENV)/.installed-dev
	$(BIN)/python -m benchmarks
	$(BIN)/python -m benchmarks.page

adapters: $(VENV)/.installed-dev
	$(BIN)/python -m validation.adapters

sample: $(VENV)/.installed
	rm -rf datasets/sample
	$(BIN)/rubgen generate rubgen/scenario/recipes/sample.toml --out datasets/sample

baselines: $(VENV)/.installed-dev
	$(BIN)/python -m validation.benchmark out/blade-rub-bench-v1
	$(BIN)/python -m validation.benchmark out/blade-rub-bench-v1 --ways 240

bench-set: $(VENV)/.installed
	$(BIN)/rubgen generate rubgen/scenario/recipes/blade-rub-bench-v1.toml --out out/blade-rub-bench-v1

verification: $(VENV)/.installed-dev
	$(BIN)/python -m validation.verification

sensitivity: $(VENV)/.installed-dev
	$(BIN)/python -m validation.sensitivity

balance: $(VENV)/.installed-dev
	$(BIN)/python -m validation.balance

confusion: $(VENV)/.installed-dev
	$(BIN)/python -m validation.confusion

run-up-motion: $(VENV)/.installed-dev
	$(BIN)/python -m validation.run_up_motion

contact: $(VENV)/.installed-dev
	$(BIN)/python -m validation.contact_options

difficulty: $(VENV)/.installed-dev
	$(BIN)/python -m validation.difficulty

faults: $(VENV)/.installed-dev
	$(BIN)/python -m validation.reliability

fuzz: $(VENV)/.installed-dev
	$(BIN)/python -m validation.reliability --only fuzz

zeng2019: $(VENV)/.installed-dev
	$(BIN)/python -m validation.zeng2019 --out out/zeng2019
	cp out/zeng2019/zeng2019*.md out/zeng2019/zeng2019-*.png docs/

zeng2019-fit: $(VENV)/.installed-dev
	$(BIN)/python -m validation.zeng2019 --fit --out out/zeng2019
	cp out/zeng2019/fit/zeng2019-fit.md docs/
	cp out/zeng2019/fit/found.json validation/zeng2019/fitting/
	cp out/zeng2019/fit/zeng2019-as-computed.toml rubgen/machine/presets/

pictures: $(VENV)/.installed-dev
	$(BIN)/python docs/pictures.py
	$(BIN)/python docs/fault_pictures.py

schemas: $(VENV)/.installed-dev
	$(BIN)/python -m schemas.make schemas docs/labels.md
	$(BIN)/python -m schemas.features_page docs/features.md
	$(BIN)/python -m schemas.option_texts
	$(BIN)/python -m schemas.reference docs/reference

reference: schemas

clean:
	rm -rf $(VENV) out build site *.egg-info

$(VENV)/bin/python:
	$(PYTHON) -c 'import sys; sys.version_info >= (3, 11) or sys.exit("rubgen needs Python 3.11 or newer: make PYTHON=python3.12 ...")'
	$(PYTHON) -m venv $(VENV)
	$(PIP) --upgrade pip  # pip 23 needs a minute more to choose versions

$(VENV)/.installed: pyproject.toml | $(VENV)/bin/python
	$(PIP) --editable .
	touch $@

$(VENV)/.installed-dev: pyproject.toml | $(VENV)/bin/python
	$(PIP) --editable '.[dev]'
	touch $@ $(VENV)/.installed
