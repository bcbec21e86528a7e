# Every command a person needs; `make help` lists them.
# Nothing outside the checkout and the cache changes: foreign programs live in $(STYLUSCAM_CACHE).
SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help
.DELETE_ON_ERROR:

PYTHON ?= python3
export STYLUSCAM_CACHE ?= $(HOME)/.cache/styluscam
VENV := .venv
BIN := $(VENV)/bin
WHEELS := target/wheels
PYTEST := $(BIN)/python -m pytest
# All, since cargo fmt skips the files whose `mod` stands in a macro.
RUST_FILES = $(shell git ls-files "rust/*.rs")
# The roots with FreeCAD and LinuxCNC are built while cargo is busy; this is where their log goes.
ROOTS_LOG := target/roots.log
# FreeCAD headless and in a window use a core each, so both run at once.
FREECAD_LOG := target/freecad.log

.PHONY: help
help: ## Lists these targets
	@grep -hE '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | sort | awk -F':.*## ' '{printf "  %-14s %s\n", $$1, $$2}'

.PHONY: demo
demo: tools ## A STEP part becomes verified G-code, from nothing
	$(PYTHON) -m venv --clear .venv-demo
	.venv-demo/bin/python -m pip install --quiet --upgrade pip
	.venv-demo/bin/python -m pip wheel --quiet --no-deps --wheel-dir target/demo .
	.venv-demo/bin/python -m pip install --quiet "$$(ls -t target/demo/styluscam-*.whl | head -n 1)[step,report]"
	.venv-demo/bin/styluscam run examples/first-light/job.toml --picture examples/first-light/out/cone_cup.png \
	  --report examples/first-light/out/cone_cup.html
	@echo
	@echo "G-code:  examples/first-light/out/cone_cup.ngc"
	@echo "picture: examples/first-light/out/cone_cup.png"
	@echo "report:  examples/first-light/out/cone_cup.html"

.PHONY: tools
tools: ## Checks that Rust and Python are new enough
	@command -v cargo >/dev/null || { echo "Rust is missing: install it from rustup.rs, 1.89 or later" >&2; exit 1; }
	@rustc --version | awk '{split($$2, v, "."); exit !(v[1] > 1 || v[2] >= 89)}' \
	  || { echo "Rust 1.89 or later is needed; this is $$(rustc --version): run rustup update" >&2; exit 1; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 10))' \
	  || { echo "Python 3.10 or later is needed: set PYTHON=python3.x" >&2; exit 1; }
	@$(PYTHON) -c 'import venv, ensurepip' 2>/dev/null \
	  || { echo "Python's venv module is missing: install the package python3-venv" >&2; exit 1; }

$(VENV)/.ready: pyproject.toml
	@$(MAKE) --no-print-directory tools
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade pip
	$(BIN)/python -m pip install --quiet "maturin>=1.9,<2" --group lint --group test
	$(BIN)/python -c 'import tomllib' 2>/dev/null || $(BIN)/python -m pip install --quiet tomli
	$(BIN)/python -m pip install --quiet $$($(BIN)/python -c "$$READ_DEPENDENCIES")
	touch $@

# The package's own dependencies and its extras, so that the environment is whole before the wheel exists.
define READ_DEPENDENCIES
import shlex
try:
    import tomllib
except ImportError:
    import tomli as tomllib
with open("pyproject.toml", "rb") as file:
    project = tomllib.load(file)["project"]
extras = project["optional-dependencies"].values()
print("\n".join(project["dependencies"] + [name for extra in extras for name in extra]).replace(" ", ""))
endef
export READ_DEPENDENCIES

# What is shipped and measured is linked as a whole: PROFILE=release. `make test` does without, since that takes minutes.
PROFILE := quick

.PHONY: dev
dev: $(VENV)/.ready ## Environment, and the engine built into it
	VIRTUAL_ENV=$(CURDIR)/$(VENV) $(BIN)/maturin develop --profile $(PROFILE) --quiet

.PHONY: wheel
wheel: PROFILE := release
wheel: $(VENV)/.ready ## The wheel, in target/wheels
	rm -rf $(WHEELS)
	$(BIN)/maturin build --profile $(PROFILE) --quiet --locked --out $(WHEELS)

# A change is judged by what it changes: its random tests begin alike, so that more cases would be the same ones again.
# Those of `quick` and `test-long` do not.
SEED := 20
CASES := 96

.PHONY: test
test: ## Everything: what CI runs
	@mkdir -p target
	@$(MAKE) --no-print-directory $(VENV)/.ready
	@$(PYTHON) tests/oracles/roots.py ensure trixie forky browser >$(ROOTS_LOG) 2>&1 & roots=$$!; \
	  tests/timed.sh lint $(MAKE) --no-print-directory lint; \
	  CARGO_INCREMENTAL=0 tests/timed.sh wheel $(MAKE) --no-print-directory wheel dev PROFILE=quick; \
	  CARGO_INCREMENTAL=0 PROPTEST_RNG_SEED=$(SEED) PROPTEST_CASES=$(CASES) tests/timed.sh cargo cargo test --workspace --profile quick --locked --quiet; \
	  wait $$roots || { cat $(ROOTS_LOG); [ -z "$${CI:-}" ] || exit 1; }; \
	  tests/timed.sh pytest $(PYTEST) -n 2 --ignore=tests/freecad --ignore=tests/window; \
	  tests/timed.sh freecad $(PYTEST) tests/freecad >$(FREECAD_LOG) 2>&1 & freecad=$$!; \
	  failed=0; tests/timed.sh window $(PYTEST) tests/window || failed=1; \
	  wait $$freecad || failed=1; cat $(FREECAD_LOG); exit $$failed
	@tests/timed.sh --report

.PHONY: test-long
test-long: tools ## Proofs by the hundred thousand: an hour or two
	PROPTEST_CASES=20000 PROPTEST_MAX_GLOBAL_REJECTS=1000000 cargo test --release --locked -p styluscam-geometry -p styluscam-verify --lib
	cargo test --release --locked -p styluscam-toolpath -- --ignored --nocapture --test-threads 1
	@$(MAKE) --no-print-directory dev PROFILE=release
	$(PYTEST) -m long -s
	@$(MAKE) --no-print-directory corpus

.PHONY: quick
quick: dev ## Cargo and Python tests that need nothing from outside
	cargo test --workspace --profile quick --locked --quiet
	$(PYTEST) -n 2 -q -m "not world and not freecad"

.PHONY: machines
machines: dev ## The pages of machines and their golden programs, written again
	$(BIN)/python docs/machine_pages.py

.PHONY: operations
operations: dev ## The page of operations and processes, written again
	$(BIN)/python docs/operation_pages.py

.PHONY: test-freecad
test-freecad: wheel ## FreeCAD tests: V=1.1 K=name
	$(PYTEST) tests/freecad $(if $(V)$(K),-k "$(V) $(K)")

.PHONY: test-window
test-window: wheel ## Tests in FreeCAD's window: V=1.1 K=name
	$(PYTEST) tests/window $(if $(V)$(K),-k "$(V) $(K)")

.PHONY: lint
lint: $(VENV)/.ready ## All linters
	rustfmt --check $(RUST_FILES)
	cargo clippy --workspace --all-targets --locked --quiet -- -D warnings
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/taplo fmt --check
	$(BIN)/typos

.PHONY: fmt
fmt: $(VENV)/.ready ## Formats everything
	rustfmt $(RUST_FILES)
	$(BIN)/ruff check --fix-only
	$(BIN)/ruff format
	$(BIN)/taplo fmt

.PHONY: bench
bench: PROFILE := release
bench: dev ## Measures ours and others side by side; writes docs/performance.md
	$(BIN)/python bench/drop_cutter.py
	$(BIN)/python bench/growth.py
	$(BIN)/python bench/planning.py
	$(BIN)/python bench/verification.py
	$(BIN)/python bench/gouges.py
	$(BIN)/python bench/report.py
	$(BIN)/python bench/simulation.py
	$(BIN)/python bench/posts.py
	$(BIN)/python bench/addon.py
	$(BIN)/python bench/machining_time.py

.PHONY: fixtures
fixtures: ## Rebuilds the STEP parts and their exact answers (Python 3.11 or later)
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' \
	  || { echo "cadquery needs Python 3.11 or later: set PYTHON=python3.x" >&2; exit 1; }
	test -x $(STYLUSCAM_CACHE)/fixtures-venv/bin/python || $(PYTHON) -m venv $(STYLUSCAM_CACHE)/fixtures-venv
	$(STYLUSCAM_CACHE)/fixtures-venv/bin/python -m pip install --quiet -r fixtures/requirements.txt
	$(STYLUSCAM_CACHE)/fixtures-venv/bin/python fixtures/make.py

# `make corpus ARGS="--slice 40"` runs a part of it; the parts stay in the cache.
.PHONY: corpus
corpus: dev ## Makes some 450 parts, runs `new` and `run` on each, and writes target/corpus.md
	test -x $(STYLUSCAM_CACHE)/fixtures-venv/bin/python || $(PYTHON) -m venv $(STYLUSCAM_CACHE)/fixtures-venv
	$(STYLUSCAM_CACHE)/fixtures-venv/bin/python -m pip install --quiet -r fixtures/requirements.txt
	$(STYLUSCAM_CACHE)/fixtures-venv/bin/python fixtures/corpus.py
	$(BIN)/python tests/corpus/run.py --out target/corpus $(ARGS)

# Pinned in vendor/package.json; the bundle is in the package, so that a wheel is built without Node.
THREE = $$(node -p 'require("./vendor/package.json").dependencies.three')
.PHONY: vendor
vendor: ## Bundles three.js for the report's page again (needs Node)
	rm -rf target/vendor && mkdir -p target/vendor && cp vendor/* target/vendor
	cd target/vendor && npm install --silent --no-audit --no-fund --no-package-lock
	rm -f python/styluscam/report/vendor/three.*
	target/vendor/node_modules/.bin/esbuild target/vendor/three.js --bundle --minify --format=iife --global-name=THREE \
	  --target=es2022 --legal-comments=none --banner:js="/* three.js $(THREE), MIT licence: see three.LICENSE */" \
	  --outfile=python/styluscam/report/vendor/three.$(THREE).min.js
	cp target/vendor/node_modules/three/LICENSE python/styluscam/report/vendor/three.LICENSE

.PHONY: addon
addon: ## The FreeCAD addon as a zip with package.xml at its root
	rm -rf target/addon
	$(PYTHON) freecad_workbench/scripts/addon_zip.py target/addon

.PHONY: translations
translations: dev ## Texts of the addon for translators, and their languages compiled
	$(BIN)/python freecad_workbench/scripts/translations.py

.PHONY: picture
picture: dev ## The picture in the README
	$(BIN)/styluscam run examples/first-light/job.toml --quiet --picture docs/first-light.png

.PHONY: profile-pictures
profile-pictures: dev ## The pictures in docs/profiles.md
	$(BIN)/python docs/profile_pictures.py

.PHONY: concept-pictures
concept-pictures: dev ## The pictures in docs/concepts
	$(BIN)/python docs/concept_pictures.py
	$(BIN)/python docs/addendum_picture.py

.PHONY: gallery
gallery: dev ## docs/gallery.md and its pictures
	$(BIN)/python docs/gallery.py

.PHONY: offset-picture
offset-picture: dev ## The picture of the offset surface in docs/guide.md
	$(BIN)/python docs/offset_picture.py

.PHONY: report-picture
report-picture: dev ## The picture of a report in docs/guide.md
	$(BIN)/python docs/report_picture.py

.PHONY: shot
shot: dev ## The pictures of FreeCAD's window in docs/images/freecad
	$(BIN)/python docs/freecad_pictures.py
