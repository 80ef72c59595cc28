# Everything a person types. Each target installs what it needs, on Debian and its kin.
BUILD := build/release
PROGRAM := $(BUILD)/apps/cairn/cairn
PREFIX ?= /usr/local
SOURCES = $(shell git ls-files '*.h' '*.cpp')

.PHONY: demo test build program bench sanitize format format-check tidy install clean

# The program on the synthetic desk, or on your own: make demo DATA=path/to/sequence
demo: program
	@scripts/demo.sh $(PROGRAM) $(DATA)

test: build
	ctest --preset release -j $(shell nproc)

# Times of every stage of tracking, beside OpenCV's ORB: make bench [DATA=path/to/sequence]
bench: program
	@$(PROGRAM) bench tracking $(if $(DATA),--data $(DATA))

build: $(BUILD)/build.ninja
	cmake --build --preset release

program: $(BUILD)/build.ninja
	cmake --build --preset release --target cairn

$(BUILD)/build.ninja: | dependencies
	cmake --preset release

.PHONY: dependencies
dependencies:
	@scripts/install-dependencies.sh

# All tests under the address, undefined-behaviour and thread sanitizers. Takes its time. The thread
# sanitizer gets one core: so TBB, which it cannot see through, starts no workers, while cairn's own
# threads are checked all the same.
sanitize: dependencies
	cmake --preset asan && cmake --build --preset asan && ctest --preset asan
	cmake --preset tsan && cmake --build --preset tsan && taskset -c 0 ctest --preset tsan

format:
	@scripts/install-dependencies.sh clang-format
	clang-format -i $(SOURCES)

format-check:
	@scripts/install-dependencies.sh clang-format
	clang-format --dry-run --Werror $(SOURCES)

# clang reads no precompiled headers of gcc, so it gets a build tree without.
tidy: dependencies
	@scripts/install-dependencies.sh clang-tidy
	cmake -S . -B build/tidy -G Ninja -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON
	run-clang-tidy -quiet -p build/tidy '/(src|apps|tests)/'

# The program and the CMake package cairn, below PREFIX.
install: build
	cmake --install $(BUILD) --prefix $(PREFIX)

clean:
	rm -rf build
