# Script: writes HEADER with the commit of SOURCE, only where it says something else. A tree without git has none.
find_package(Git QUIET)
set(commit "")
set(dirty 0)
if(GIT_FOUND AND EXISTS ${SOURCE}/.git)
  execute_process(COMMAND ${GIT_EXECUTABLE} rev-parse HEAD WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE commit
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  execute_process(COMMAND ${GIT_EXECUTABLE} status --porcelain --untracked-files=no WORKING_DIRECTORY ${SOURCE}
    OUTPUT_VARIABLE changes OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(NOT changes STREQUAL "")
    set(dirty 1)
  endif()
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT "#define BRICK_COMMIT \"${commit}\"\n#define BRICK_DIRTY ${dirty}\n")
