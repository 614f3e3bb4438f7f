# Short commands for common tasks. CMakePresets.json contains the settings of the builds.
JOBS ?= $(shell nproc)

# VIEWER=OFF builds without the viewer, which needs npm and a compiler for WebAssembly.
VIEWER ?= ON
configure_release = cmake --preset release -DSUPPLE_BUILD_VIEWER=$(VIEWER)

BASE ?= HEAD

SECONDS ?= 30

.PHONY: help demo program experiment paper test test-python build fuzz coverage bench bench-quick bench-kernels bench-compare contest check format docs figures pictures clean dependencies

help:
	@echo 'make demo     build the program, drop a cloth over a ball, collide nine objects, write a page that shows them'
	@echo 'make program  only the program; with VIEWER=OFF without the viewer, so without npm and WebAssembly'
	@echo 'make test     build, then every test but long ones, which .ci/run all runs'
	@echo 'make test-python  the Python package with the libraries of make program, and its tests'
	@echo 'make build    the release build: build/release/bin/supple'
	@echo 'make fuzz     every fuzz target with sanitizers, for SECONDS=30 each'
	@echo 'make coverage which lines and branches the tests and the corpora of the fuzz targets reach'
	@echo 'make bench    Supple against Embree, CGAL, FCL, Bullet and ODE: up to 25 minutes; bench-quick takes one'
	@echo 'make bench-kernels   single stages and kernels of Supple'
	@echo 'make bench-compare BASE=COMMIT   this working tree against a commit'
	@echo 'make check    format, include order, prose, changelog, file sizes, budgets, public interface, generated documents'
	@echo 'make format   format the C++ sources'
	@echo 'make docs     write the documents that are generated from the command line and the headers'
	@echo 'make paper    repeat the paper: every figure, its table and its claims, on one page; QUICK=1 takes five minutes'
	@echo 'make figures  draw docs/figures/*.svg from their text (needs graphviz)'
	@echo 'make pictures  draw docs/images: the scenes by supple render, and the page of the viewer'
	@echo 'make clean    remove build/'

demo: program
	build/release/bin/supple simulate scenes/cloth_over_ball.toml --frames 200 --record build/cloth.h5
	@echo
	build/release/bin/supple simulate scenes/nine.toml --frames 200
	@echo
ifneq ($(VIEWER),OFF)
	build/release/bin/supple view scenes/nine.toml --export build/nine.html
	@echo
	@echo 'Open build/nine.html in a browser: it is one file, needs no server, and shows the nine objects collide.'
	@echo 'Try next: build/release/bin/supple view scenes/cloth_over_ball.toml'
endif
	@echo 'ParaView opens build/cloth.xdmf.'
	@echo 'Try next: build/release/bin/supple detect scenes/nine.toml --frames 3 --verify --json -'

# The command line and its viewer, without tests and examples. VIEWER=OFF leaves out the viewer.
program: dependencies
	$(configure_release)
	cmake --build --preset release -j $(JOBS) --target supple_cli

# The program of the paper's experiments. The generated documents have its options, too.
experiment: program
	cmake --build --preset release -j $(JOBS) --target supple_experiment

# Hours; QUICK=1 runs small versions. What is complete in build/paper is not repeated.
paper: experiment
	experiments/paper.py $(if $(QUICK),--quick --output build/paper_quick,--output build/paper) --program build/release/bin/supple

# Without the tests that compile the library again and those that take long.
test: build
	ctest --preset release --label-exclude 'compiles|long'

# The tests of the Python package, for which pip installs what they need in build/python.
test-python: program
	tools/install_dependencies.sh --python
	tools/test_python.sh

build: dependencies
	$(configure_release)
	cmake --build --preset release -j $(JOBS)

# FUZZ contains options of the script: make fuzz SECONDS=600 FUZZ="obj scene --keep --record"
fuzz:
	tools/install_dependencies.sh --ci
	cmake --preset fuzz
	cmake --build --preset fuzz -j $(JOBS)
	fuzz/run.py --seconds $(SECONDS) $(FUZZ)

# COVERAGE contains options of the script: make coverage COVERAGE=--record
coverage:
	tools/install_dependencies.sh --coverage
	cmake --preset coverage
	cmake --build --preset coverage -j $(JOBS)
	tools/coverage.py $(COVERAGE)

# CONTEST contains options of the script: make bench CONTEST="--only 'B/*' --save"
bench: contest
	benchmarks/contest.py $(CONTEST)

bench-quick: contest
	benchmarks/contest.py --quick $(CONTEST)

contest:
	tools/install_dependencies.sh --bench
	cmake --preset release -DSUPPLE_BUILD_PEER_BENCHMARKS=ON
	cmake --build --preset release -j $(JOBS) --target contest

bench-kernels: dependencies
	cmake --preset release -DSUPPLE_BUILD_BENCHMARKS=ON
	cmake --build --preset release -j $(JOBS)
	build/release/bin/supple_benchmarks

bench-compare: dependencies
	benchmarks/contest_compare.py $(BASE) $(CONTEST)

check: experiment
	tools/install_dependencies.sh --ci
	tools/format.sh --check
	tools/check_include_order.py
	tools/check_prose.py
	tools/check_changelog.sh
	tools/check_file_sizes.sh
	tools/budgets.py
	tools/make_api.py --check
	tools/make_python.py --check
	tools/check_api.py
	tools/make_paper.py --check
	benchmarks/distributed_model.py --check
	tools/generate_docs.sh --check build/release/bin/supple

format:
	tools/install_dependencies.sh --ci
	tools/format.sh

# Draws the figures of the documents from their text (needs graphviz).
figures: $(patsubst %.dot,%.svg,$(wildcard docs/figures/*.dot))

docs/figures/%.svg: docs/figures/%.dot
	dot -Tsvg $< -o $@

pictures: program
	tools/draw_figures.sh build/release/bin/supple
	node viewer/page/e2e/tools/figures.mjs build/release/bin/supple

docs: experiment
	tools/install_dependencies.sh --ci
	tools/make_api.py
	tools/make_python.py
	tools/make_paper.py
	tools/generate_docs.sh build/release/bin/supple

clean:
	rm -rf build

dependencies:
	tools/install_dependencies.sh $(if $(filter OFF,$(VIEWER)),--without-viewer)
