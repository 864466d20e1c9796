# brick_add_build_info(TARGET): a library with what `brick --version` and every result say of who made them: commit,
# whether the tree differed from it, tool versions. Looked at in each build, because a commit changes no source.
function(brick_add_build_info target)
  set(header ${CMAKE_BINARY_DIR}/build_info/build_commit.h)
  add_custom_target(brick_build_commit ALL BYPRODUCTS ${header} VERBATIM
    COMMAND ${CMAKE_COMMAND} -D SOURCE=${CMAKE_SOURCE_DIR} -D HEADER=${header}
            -P ${CMAKE_SOURCE_DIR}/cmake/WriteBuildCommit.cmake)
  add_library(${target} STATIC ${CMAKE_SOURCE_DIR}/app/build_info.cpp)
  add_dependencies(${target} brick_build_commit)
  target_compile_options(${target} PRIVATE ${BRICK_WARNINGS})
  target_include_directories(${target} PRIVATE ${CMAKE_BINARY_DIR}/build_info)
  target_compile_definitions(${target} PRIVATE BRICK_VERSION="${PROJECT_VERSION}"
    BRICK_COMPILER="${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}" BRICK_VERILATOR="${verilator_VERSION}"
    BRICK_BUILD_TYPE="${CMAKE_BUILD_TYPE}")
  target_link_libraries(${target} PUBLIC nlohmann_json::nlohmann_json PRIVATE fmt::fmt brick_text brick_systemc)
  brick_precompiled(${target})
endfunction()
