# brick_add_test(NAME unit_ticks SOURCES a.cpp LIBRARIES brick_core): a GoogleTest executable, one ctest entry a test,
# label `unit`. SANITIZED: under the address and undefined-behaviour sanitizers in every build, whatever the preset.
# QUICK: its tests take little time, so the compiler shall take little too: not optimised.
# TOGETHER [ALONE a.cpp ...]: brick_together(), names that are local to a file differ in all the others.
# ENVIRONMENT A=1 ...: of the tests in ctest.
# NIGHT Suite.Name/Lockstep ...: patterns of tests that only `ctest -C night` runs, an entry each of that name.
# brick_sanitize(TARGET): the same for a library; what links it is sanitized too.
# brick_test_code(TARGET [SANITIZED | QUICK]): how code that only tests use is compiled. It is most of the compiler's
# work and little of the processor's later on, so it is optimised less, and the headers that nearly all of it includes
# are compiled once.
include(GoogleTest)
function(brick_sanitize target)
  target_compile_options(${target} PUBLIC ${BRICK_SANITIZER_FLAGS} -O1 -g1)
  target_link_options(${target} PUBLIC ${BRICK_SANITIZER_LINK_FLAGS})
endfunction()

# What sanitized tests test stands in libraries, at -O1 but for some of them. In the tests the checks of undefined
# behaviour are much of the compiler's work; the address sanitizer stays, for the arrays that they lend, and ./dev asan
# has both.
set(test_options $<$<CONFIG:Release>:-O1>)
set(quick_test_options $<$<CONFIG:Release>:-O0>)
set(sanitized_test_options -O0)  # behind brick_sanitize(), whose -O1 would undo it
if(NOT BRICK_SANITIZE)
  list(APPEND sanitized_test_options -fno-sanitize=undefined)
endif()

# A file of nothing owns the precompiled headers of one set of flags (cmake/Headers.cmake).
function(brick_add_test_headers name)
  brick_add_headers(${name} <gmock/gmock.h> <gtest/gtest.h> <fstream> <random> ${ARGN})
  target_link_libraries(${name} PRIVATE GTest::gtest GTest::gmock)
endfunction()
brick_add_headers(brick_sanitized_headers <systemc>)
brick_sanitize(brick_sanitized_headers)
brick_add_test_headers(brick_test_headers <systemc>)
target_compile_options(brick_test_headers PRIVATE ${test_options})
brick_add_test_headers(brick_quick_test_headers <systemc>)
target_compile_options(brick_quick_test_headers PRIVATE ${quick_test_options})
brick_add_test_headers(brick_sanitized_test_headers)
brick_sanitize(brick_sanitized_test_headers)
target_compile_options(brick_sanitized_test_headers PRIVATE ${sanitized_test_options})

function(brick_test_code target)
  cmake_parse_arguments(T "SANITIZED;QUICK" "" "" ${ARGN})
  target_compile_options(${target} PRIVATE ${BRICK_WARNINGS})
  target_link_libraries(${target} PRIVATE GTest::gtest GTest::gmock fmt::fmt)
  if(T_SANITIZED)
    brick_sanitize(${target})
    target_compile_options(${target} PRIVATE ${sanitized_test_options})
    target_precompile_headers(${target} REUSE_FROM brick_sanitized_test_headers)
  else()
    if(T_QUICK)
      target_compile_options(${target} PRIVATE ${quick_test_options})
      target_precompile_headers(${target} REUSE_FROM brick_quick_test_headers)
    else()
      target_compile_options(${target} PRIVATE ${test_options})
      target_precompile_headers(${target} REUSE_FROM brick_test_headers)
    endif()
    target_link_libraries(${target} PRIVATE brick_systemc)  # its headers are among them
  endif()
endfunction()

# brick_when(VAR NAME [OTHER ...]): VAR becomes what add_test() takes for a test that only `ctest -C night` runs, if
# NAME is one of the others, else nothing.
function(brick_when var name)
  set(when "")
  if(name IN_LIST ARGN)
    set(when CONFIGURATIONS night)
  endif()
  set(${var} ${when} PARENT_SCOPE)
endfunction()

function(brick_add_test)
  cmake_parse_arguments(T "SANITIZED;QUICK;TOGETHER" "NAME;TIMEOUT" "SOURCES;LIBRARIES;ALONE;ENVIRONMENT;NIGHT"
                        ${ARGN})
  if(NOT T_TIMEOUT)
    set(T_TIMEOUT 300)
    if(BRICK_COVERAGE)
      set(T_TIMEOUT 1800)
    endif()
  endif()
  set(kind "")
  if(T_SANITIZED)
    set(kind SANITIZED)
  elseif(T_QUICK)
    set(kind QUICK)
  endif()
  add_executable(${T_NAME} ${T_SOURCES})
  brick_test_code(${T_NAME} ${kind})
  if(T_TOGETHER)
    brick_together(${T_NAME} ALONE ${T_ALONE})
  endif()
  target_link_libraries(${T_NAME} PRIVATE ${T_LIBRARIES} GTest::gtest_main)
  set(by_day "")
  if(T_NIGHT)
    list(JOIN T_NIGHT ":" at_night)
    set(by_day TEST_FILTER "-${at_night}")
  endif()
  gtest_discover_tests(${T_NAME} ${by_day} DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT ${T_TIMEOUT} LABELS unit
                       ENVIRONMENT "${T_ENVIRONMENT}" WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
  math(EXPR longer "4 * ${T_TIMEOUT}")
  foreach(pattern ${T_NIGHT})
    add_test(NAME ${pattern} CONFIGURATIONS night COMMAND ${T_NAME} --gtest_filter=${pattern}
             WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
    set_tests_properties(${pattern} PROPERTIES TIMEOUT ${longer} LABELS unit  # a pattern of no test fails
                         FAIL_REGULAR_EXPRESSION "Running 0 tests")
  endforeach()
endfunction()
