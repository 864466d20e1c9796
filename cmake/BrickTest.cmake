# brick_add_test(NAME unit_ticks SOURCES a.cpp LIBRARIES brick_core): a GoogleTest executable, one ctest entry a test,
# label `unit`. SANITIZED: under the address and undefined-behaviour sanitizers in every build, whatever the preset.
# brick_sanitize(TARGET): the same for a library; what links it is sanitized too.
include(GoogleTest)
function(brick_sanitize target)
  target_compile_options(${target} PUBLIC ${BRICK_SANITIZER_FLAGS} -O1 -g1)
  target_link_options(${target} PUBLIC ${BRICK_SANITIZER_FLAGS})
endfunction()

function(brick_add_test)
  cmake_parse_arguments(T "SANITIZED" "NAME;TIMEOUT" "SOURCES;LIBRARIES" ${ARGN})
  if(NOT T_TIMEOUT)
    set(T_TIMEOUT 300)
  endif()
  add_executable(${T_NAME} ${T_SOURCES})
  target_compile_options(${T_NAME} PRIVATE ${BRICK_WARNINGS})
  if(T_SANITIZED)
    brick_sanitize(${T_NAME})
    target_compile_options(${T_NAME} PRIVATE -Wno-maybe-uninitialized)  # instrumented code makes g++ 12 warn in <regex>
  endif()
  target_link_libraries(${T_NAME} PRIVATE ${T_LIBRARIES} GTest::gtest GTest::gmock GTest::gtest_main)
  gtest_discover_tests(${T_NAME} DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT ${T_TIMEOUT} LABELS unit
                       WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
endfunction()
