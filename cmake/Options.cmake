# Warnings, sanitizers, coverage and compiler cache.
option(BRICK_SANITIZE "Address and undefined-behaviour sanitizers" OFF)
option(BRICK_COVERAGE "Line coverage of C++ and of the RTL" OFF)
option(BRICK_NETLIST "Yosys' gates of the servo IC and of the board of two in the place of their RTL" OFF)
option(BRICK_NETLIST_PLANTED "Those of RTL with a fault (tools/netlist.py)" OFF)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")
find_program(CCACHE ccache)
if(CCACHE)
  # Sources that include a precompiled header are kept only with these two liberties (ccache's manual).
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${CCACHE})
endif()
set(BRICK_WARNINGS -Wall -Wextra -Werror -Wshadow -Wno-unused-parameter)
# How Verilated code is compiled, and how what runs once of it: its set-up and its initial values, half of the code. The
# speed of the rest decides the speed of a release; elsewhere a short build counts more. Under the sanitizers it stays
# uninstrumented: it is generated, and what is hunted are errors in our own code.
if(CMAKE_BUILD_TYPE STREQUAL "Release" AND NOT BRICK_SANITIZE AND NOT BRICK_COVERAGE)
  set(BRICK_RTL_OPT -O3)
  set(BRICK_RTL_SLOW_OPT -O1)
elseif(BRICK_SANITIZE)
  set(BRICK_RTL_OPT -O1 -fno-sanitize=all)
  set(BRICK_RTL_SLOW_OPT -O0 -fno-sanitize=all)
elseif(BRICK_COVERAGE)
  set(BRICK_RTL_OPT -O1 -fno-profile-arcs -fno-test-coverage)  # it counts by itself, in lines of the RTL
  set(BRICK_RTL_SLOW_OPT -O0 -fno-profile-arcs -fno-test-coverage)  # most of the code here
else()
  set(BRICK_RTL_OPT -O1)
  set(BRICK_RTL_SLOW_OPT -O0)
endif()
# What does little while a simulation runs, and costs the compiler much: pages, commands, files of boards, benches.
set(BRICK_SHORT_OPT $<$<CONFIG:Release>:-O1>)
set(BRICK_RTL_ARGS "")  # verilate(... VERILATOR_ARGS ... ${BRICK_RTL_ARGS})
set(BRICK_RTL_BITS "")  # of chips and modules: brick_add_rtl_module(... ARGS ${BRICK_RTL_BITS})
if(BRICK_COVERAGE)
  set(BRICK_RTL_ARGS --coverage-line)
  set(BRICK_RTL_BITS --coverage-toggle)
endif()

# Flags of the sanitizers, for the whole tree (preset asan) and for the few native libraries that every build tests with
# them.
set(BRICK_SANITIZER_FLAGS -fsanitize=address,undefined -fno-omit-frame-pointer -fno-sanitize-recover=undefined)
# Linked to a fixed place. Where the kernel moves programs by 32 random bits (vm.mmap_rnd_bits; many do since Linux
# 6.5), one start in four would fall into what the runtime of g++ 12 keeps for its heap, and die before main().
set(BRICK_SANITIZER_LINK_FLAGS ${BRICK_SANITIZER_FLAGS} -no-pie)
if(BRICK_SANITIZE)
  set(CMAKE_CXX_FLAGS_RELEASE "-O1 -g1")  # a short build, line numbers in reports, assertions on
  list(APPEND BRICK_WARNINGS -Wno-maybe-uninitialized)  # instrumented code makes g++ 12 warn inside <regex>
  add_compile_options(${BRICK_SANITIZER_FLAGS})
  add_link_options(${BRICK_SANITIZER_LINK_FLAGS})
endif()
if(BRICK_COVERAGE)
  add_compile_options(--coverage -O1 -g0)  # nobody debugs it
  add_link_options(--coverage)
endif()
