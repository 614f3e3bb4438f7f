# The short way to everything; CMakePresets.json holds the details.
JOBS ?= $(shell nproc)

.PHONY: help demo test build bench check format docs clean dependencies

help:
	@echo 'make demo     build, then a cloth that falls over a ball, and nine objects that collide'
	@echo 'make test     build, then every test'
	@echo 'make build    the release build: build/release/bin/supple'
	@echo 'make bench    build and run the benchmarks'
	@echo 'make check    format, include order, changelog, generated documents'
	@echo 'make format   format the C++ sources'
	@echo 'make docs     write the documents that are generated from the command line'
	@echo 'make clean    remove build/'

demo: build
	build/release/bin/supple simulate scenes/table1_9.toml --steps 1000
	@echo
	build/release/bin/supple simulate scenes/cloth_over_ball.toml --steps 200 --record build/cloth.h5
	@echo
	@echo 'ParaView opens build/cloth.xdmf.'
	@echo 'Try next: build/release/bin/supple detect scenes/nine.toml --steps 3 --verify --json -'

test: build
	ctest --preset release

build: dependencies
	cmake --preset release
	cmake --build --preset release -j $(JOBS)

bench: dependencies
	cmake --preset release -DSUPPLE_BUILD_BENCHMARKS=ON
	cmake --build --preset release -j $(JOBS)
	build/release/bin/supple_benchmarks

check: build
	tools/install_dependencies.sh --ci
	tools/format.sh --check
	tools/check_include_order.py
	tools/check_changelog.sh
	tools/generate_docs.sh --check build/release/bin/supple

format:
	tools/install_dependencies.sh --ci
	tools/format.sh

docs: build
	tools/generate_docs.sh build/release/bin/supple

clean:
	rm -rf build

dependencies:
	tools/install_dependencies.sh
