# Headers that nearly every source includes are compiled once for each set of flags: of SystemC, {fmt} and the standard
# library they are most of what the compiler reads.
# brick_add_headers(NAME <header>...): their owner, a file of nothing; what else has the same flags takes them by
# REUSE_FROM. brick_precompiled(TARGET...): our own code with the warnings and flags of a release.
function(brick_add_headers name)
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/${name}.cpp CONTENT "")
  add_library(${name} OBJECT ${CMAKE_BINARY_DIR}/${name}.cpp)
  target_link_libraries(${name} PRIVATE brick_systemc fmt::fmt)
  target_compile_options(${name} PRIVATE ${BRICK_WARNINGS})
  target_precompile_headers(${name} PRIVATE <fmt/format.h> <algorithm> <array> <cstdint> <functional> <map> <memory>
    <optional> <sstream> <string> <vector> ${ARGN})
endfunction()
brick_add_headers(brick_headers <systemc>)

function(brick_precompiled)
  foreach(target ${ARGN})
    target_precompile_headers(${target} REUSE_FROM brick_headers)
  endforeach()
endfunction()

# brick_together(TARGET [ALONE source...]): eight sources are one for the compiler, because what they all instantiate
# and inline is half of its work. Names that are local to a file must differ then, in all but those that stay alone. Not
# for debugging, where one source is built again and again, nor for coverage; tools/tidy.py takes them apart.
set(BRICK_TOGETHER OFF)
if(CMAKE_BUILD_TYPE STREQUAL "Release" AND NOT BRICK_COVERAGE)
  set(BRICK_TOGETHER ON)
endif()
function(brick_together target)
  cmake_parse_arguments(T "" "" "ALONE" ${ARGN})
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${BRICK_TOGETHER} UNITY_BUILD_BATCH_SIZE 8)
  set_source_files_properties(${T_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()
