# SPDX-License-Identifier: GPL-3.0-or-later
# The front door. `make demo` and `make test` go from a fresh clone to their end with no other step.

# As many compilers as cores, but no more than one for each 2 GiB of free memory.
JOBS ?= $(shell awk -v cores="$$(nproc)" '/^MemAvailable/ { m = int($$2 / 2097152); n = m < cores ? m : cores; print n < 1 ? 1 : n }' /proc/meminfo)
SOURCES = $(shell git ls-files '*.h' '*.cpp')
PHIZ = build/release/apps/phiz/phiz

.PHONY: build demo test debug bench format lint setup clean

build: setup ## Build the release
	cmake --preset release -Wno-dev
	ninja -C build/release -j$(JOBS)

demo: setup ## Head, performance, simulation, film and glTF in out/demo
	cmake --preset release -Wno-dev
	ninja -C build/release -j$(JOBS) phiz
	scripts/demo $(PHIZ) out/demo

test: setup ## All tests, and those of the lower folders and of io under sanitizers; ends with one summary
	cmake --preset release -Wno-dev
	ninja -C build/release -j$(JOBS)
	cmake --preset debug -Wno-dev -DPHIZ_TEST_FOLDERS="core;geometry;numerics;elasticity;io"
	ninja -C build/debug -j$(JOBS) tests
	scripts/ctest-all -j$(JOBS) build/release build/debug

debug: setup ## Build everything with AddressSanitizer and UBSan and run all tests there
	cmake --preset debug -Wno-dev -DPHIZ_TEST_FOLDERS=
	ninja -C build/debug -j$(JOBS)
	ctest --preset debug -j$(JOBS)

bench: build ## Measure and print JSON
	$(PHIZ) bench volumetric --json -

format: ## Format all sources
	clang-format -i $(SOURCES)

lint: setup ## Check the format and run clang-tidy
	clang-format --dry-run --Werror $(SOURCES)
	cmake --preset release -B build/lint -DPHIZ_UNITY=OFF -Wno-dev
	scripts/tidy build/lint -j$(JOBS)

setup: ## Install what is missing
	@scripts/setup

clean: ## Remove what was built
	rm -rf build out
