# `make demo` and `make test` are all the set-up there is: each first makes .venv with the pinned packages it needs.
PYTHON ?= python3
VENV ?= .venv
BIN = $(VENV)/bin
EXTRAS = video,report,paper,explore,optimize,build,step,cluster,c3d
GROUPS = --group test --group lint --group docs --group mjx
PIP = $(BIN)/pip install --quiet -c constraints.txt
# Python keeps what it compiles, even where the environment says otherwise: half of what a worker does before its first test.
PYTEST = PYTHONDONTWRITEBYTECODE= $(BIN)/python -m pytest --numprocesses auto --dist worksteal

.PHONY: demo test test-long lint docs format benchmark catalogue reproduce verification models pictures readers dist clean

demo: $(VENV)/.for-demo
	mkdir -p demo
	$(BIN)/fes_mj simulate d1 --render demo/d1.mp4 --out demo
	@echo "Look at demo/d1.mp4; the numbers are in demo/d1-p1p2.json and demo/d1-p1p2.csv, the model in demo/d1-p1p2.xml."

# What is wrong with the code, in a minute and a half; test-long runs the rest: what takes long, what starts processes.
test: $(VENV)/.ready
	$(PYTEST) -m "not long and not process"

test-long: $(VENV)/.ready
	$(PYTEST) -m "long or process"

lint: $(VENV)/.ready
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports

# The site, in site/: README, tutorials, results, and a page for each module; a link that leads nowhere stops it.
docs: $(VENV)/.ready
	$(BIN)/python -m sphinx -c docs -b html --jobs auto --fail-on-warning --keep-going --quiet . site

format: $(VENV)/.ready
	$(BIN)/ruff format .
	$(BIN)/ruff check --fix .

# Speed, as ratios within one run, beside other programs: results/benchmarks/, each with the commit it was measured at.
benchmark: $(VENV)/.ready
	$(PIP) --group benchmark
	for name in core start exudyn muscles optimization ride video; do $(BIN)/python -m benchmarks.$$name || exit 1; done

# Every check on every design, refined, with all faults injected: results/verification.md; every ride by both solvers:
# results/ride_verification.md; muscles in MuJoCo: results/muscle_verification.md; what muscles leave of the gains:
# results/muscles.md; what of it agrees with measurements: results/published.md; what each setting of the simulation is worth: results/settings.md
verification: $(VENV)/.ready
	$(BIN)/python tools/update_verification.py
	$(BIN)/python -m studies.ride_verification
	$(BIN)/python -m studies.muscles
	$(BIN)/python -m studies.muscle_trials
	$(BIN)/python -m studies.muscle_verification
	$(BIN)/python -m studies.published
	$(BIN)/python -m studies.settings

# What the package ships as data: the identified designs, the recovered moments and the riders who may have given them.
catalogue: $(VENV)/.ready
	$(BIN)/python tools/make_catalogue.py
	$(BIN)/python tools/reconstruct_moments.py
	$(BIN)/python -m tools.fit_muscles

# The paper's tables and figures beside ours: results/
reproduce: $(VENV)/.ready
	$(BIN)/fes_mj reproduce

# The exported models of the five designs, in mjcf/.
models: $(VENV)/.ready
	$(BIN)/python tools/make_models.py

# Every picture of README, docs, mjcf/ and results/ again; that of the ripple from ripple.json.
pictures: $(VENV)/.ready reproduce
	$(BIN)/python tools/make_models.py --pictures
	$(BIN)/python -m tools.picture_demo
	$(BIN)/python -m tools.picture_explore
	$(BIN)/python -m studies.ripple --picture
	$(BIN)/python -m studies.muscles
	$(BIN)/python -m studies.published
	$(BIN)/python -m studies.ride_env
	$(BIN)/python -m tools.picture_structure

# The other readers of the models beside MuJoCo: results/readers.md; most need an environment of their own.
readers: .readers/.ready
	$(BIN)/python -m tools.conformance

.readers/.ready: $(VENV)/.ready tools/conformance/readers.py
	$(BIN)/python -m tools.conformance.build
	touch $@

# A wheel and an sdist as a user installs them, without constraints, each in an environment of its own: do they simulate?
dist: $(VENV)/.ready
	rm -rf dist
	$(BIN)/python -m build --quiet --outdir dist
	for file in dist/*.whl dist/*.tar.gz; do \
		$(PYTHON) -m venv --clear dist/empty && dist/empty/bin/pip install --quiet "$$file" && \
		(cd dist && empty/bin/fes_mj simulate d1 -q) || exit 1; \
	done

$(VENV)/.for-demo: WANTED = -e '.[video,explore]'
$(VENV)/.ready: WANTED = -e '.[$(EXTRAS)]' $(GROUPS)
$(VENV)/.for-demo $(VENV)/.ready: pyproject.toml constraints.txt
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
		{ echo "Python 3.11 or newer is needed; name one with make PYTHON=python3.12 ..."; exit 1; }
	$(PYTHON) -m venv $(VENV)
	$(PIP) pip  # the one that venv brings may not know --group
	$(PIP) $(WANTED)
	# OpenGL for machines without any: only the library inside this wheel is used, so its own dependencies stay out
	-@[ "$$(uname -sm)" != "Linux x86_64" ] || $(PIP) --no-deps lavavu-osmesa
	touch $@

clean:
	rm -rf .venv* .readers demo dist site docs/reference
