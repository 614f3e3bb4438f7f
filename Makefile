# The short way to everything; CMakePresets.json holds the details.
JOBS ?= $(shell nproc)

BASE ?= HEAD

.PHONY: help demo test build bench bench-quick bench-kernels bench-compare contest check format docs figures clean dependencies

help:
	@echo 'make demo     build, then a cloth that falls over a ball, and nine objects that collide'
	@echo 'make test     build, then every test'
	@echo 'make build    the release build: build/release/bin/supple'
	@echo 'make bench    Supple against Embree, CGAL, FCL, Bullet and ODE: up to 25 minutes; bench-quick takes one'
	@echo 'make bench-kernels   stages and kernels of Supple by themselves'
	@echo 'make bench-compare BASE=COMMIT   this working tree against a commit'
	@echo 'make check    format, include order, changelog, generated documents'
	@echo 'make format   format the C++ sources'
	@echo 'make docs     write the documents that are generated from the command line'
	@echo 'make figures  draw docs/figures/*.svg from their text (needs graphviz)'
	@echo 'make clean    remove build/'

demo: build
	build/release/bin/supple simulate scenes/table1_9.toml --frames 1000
	@echo
	build/release/bin/supple simulate scenes/cloth_over_ball.toml --frames 200 --record build/cloth.h5
	@echo
	@echo 'ParaView opens build/cloth.xdmf.'
	@echo 'Try next: build/release/bin/supple view scenes/nine.toml'
	@echo '          build/release/bin/supple detect scenes/nine.toml --frames 3 --verify --json -'

test: build
	ctest --preset release

build: dependencies
	cmake --preset release
	cmake --build --preset release -j $(JOBS)

# CONTEST passes options on: make bench CONTEST="--only 'B/*' --save"
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

check: build
	tools/install_dependencies.sh --ci
	tools/format.sh --check
	tools/check_include_order.py
	tools/check_changelog.sh
	tools/generate_docs.sh --check build/release/bin/supple

format:
	tools/install_dependencies.sh --ci
	tools/format.sh

# The figures of the documents, from text (needs graphviz).
figures: $(patsubst %.dot,%.svg,$(wildcard docs/figures/*.dot))

docs/figures/%.svg: docs/figures/%.dot
	dot -Tsvg $< -o $@

docs: build
	tools/generate_docs.sh build/release/bin/supple

clean:
	rm -rf build

dependencies:
	tools/install_dependencies.sh
