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
