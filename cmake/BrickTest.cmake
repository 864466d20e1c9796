# brick_add_test(NAME unit_ticks SOURCES a.cpp LIBRARIES brick_core): a GoogleTest executable, one ctest entry a test, label `unit`.
include(GoogleTest)
function(brick_add_test)
  cmake_parse_arguments(T "" "NAME;TIMEOUT" "SOURCES;LIBRARIES" ${ARGN})
  if(NOT T_TIMEOUT)
    set(T_TIMEOUT 300)
  endif()
  add_executable(${T_NAME} ${T_SOURCES})
  target_compile_options(${T_NAME} PRIVATE ${BRICK_WARNINGS})
  target_link_libraries(${T_NAME} PRIVATE ${T_LIBRARIES} GTest::gtest GTest::gmock GTest::gtest_main)
  gtest_discover_tests(${T_NAME} DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT ${T_TIMEOUT} LABELS unit
                       WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
endfunction()
