# How RTL is Verilated: the flags of every model in one place, and the libraries of modules under test.
set(BRICK_RTL ${CMAKE_SOURCE_DIR}/rtl)

# brick_rtl_list(sources servo_ic): the files of rtl/servo_ic.f, in its order. What is not in a list is not built.
function(brick_rtl_list sources top)
  file(STRINGS ${BRICK_RTL}/${top}.f files REGEX "^[^/]")
  list(TRANSFORM files PREPEND ${BRICK_RTL}/)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${BRICK_RTL}/${top}.f)
  set(${sources} ${files} PARENT_SCOPE)
endfunction()

file(GLOB_RECURSE rtl_files RELATIVE ${BRICK_RTL} CONFIGURE_DEPENDS ${BRICK_RTL}/*.sv)
file(GLOB rtl_lists ${BRICK_RTL}/*.f)
foreach(list ${rtl_lists})
  file(STRINGS ${list} listed)
  list(REMOVE_ITEM rtl_files ${listed})
endforeach()
foreach(file ${rtl_files})
  message(WARNING "rtl/${file} is in no file list, so nothing is built of it: ./dev cores writes the lists")
endforeach()

# brick_verilate(brick_rtl TOP board_sim PREFIX Vboard_s2 CONFIG a.vlt SOURCES a.sv ARGS -GMask=1): one model more in a
# library, of its list of files when it says no others. Flip-flops and memories start as its context's randReset() says.
function(brick_verilate library)
  cmake_parse_arguments(V "" "TOP;PREFIX" "CONFIG;SOURCES;ARGS" ${ARGN})
  if(V_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "brick_verilate(${library}): nobody reads ${V_UNPARSED_ARGUMENTS}")
  endif()
  if(NOT V_SOURCES)
    brick_rtl_list(V_SOURCES ${V_TOP})
  endif()
  # Verilator runs in this folder and writes the names as it gets them: the tree's own place is in no library.
  foreach(source ${V_CONFIG} ${V_SOURCES})
    file(RELATIVE_PATH source ${CMAKE_CURRENT_SOURCE_DIR} ${source})
    list(APPEND sources ${source})
  endforeach()
  verilate(${library} TOP_MODULE ${V_TOP} PREFIX ${V_PREFIX} SOURCES ${sources}
    VERILATOR_ARGS -O3 --x-assign fast --x-initial unique ${V_ARGS} ${BRICK_RTL_ARGS}
    OPT_GLOBAL ${BRICK_RTL_OPT})
  brick_join_verilated(${library} ${V_PREFIX})
endfunction()

# brick_netlist(sources servo_ic): the same as gates, of board_top with what stands around it. Made when CMake runs, as
# Verilator's code is.
function(brick_netlist sources top)
  set(folder ${CMAKE_BINARY_DIR}/netlist)
  brick_rtl_list(rtl ${top})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${rtl} ${CMAKE_SOURCE_DIR}/tools/netlist.py)
  if(BRICK_NETLIST_PLANTED)
    set(planted --planted)
  endif()
  execute_process(COMMAND ${Python3_EXECUTABLE} tools/netlist.py ${top} ${folder} ${planted}
                  WORKING_DIRECTORY ${CMAKE_SOURCE_DIR} COMMAND_ERROR_IS_FATAL ANY)
  set(files ${BRICK_RTL}/pins/motor_pins_pkg.sv ${folder}/${top}.v)
  if(top STREQUAL board_top)
    list(APPEND files ${BRICK_RTL}/host/dpram_memory.sv ${folder}/board_sim.sv)
  endif()
  set(${sources} ${files} PARENT_SCOPE)
endfunction()

# A model is some ten files, most of them short, which all read the same headers: two thirds of the compiler's work. So
# they are compiled as two: what runs at each evaluation, and what runs once.
function(brick_join_verilated library prefix)
  get_target_property(files ${library} SOURCES)
  list(FILTER files INCLUDE REGEX "/${prefix}\\.dir/.*\\.cpp$")
  set_source_files_properties(${files} PROPERTIES HEADER_FILE_ONLY ON)  # still what Verilator's command makes
  set(fast ${files})
  set(slow ${files})
  list(FILTER fast EXCLUDE REGEX "__(Slow|Syms)\\.cpp$")
  list(FILTER slow INCLUDE REGEX "__(Slow|Syms)\\.cpp$")
  foreach(part fast slow)
    set(text "")
    foreach(file ${${part}})
      file(RELATIVE_PATH file ${CMAKE_CURRENT_BINARY_DIR} ${file})
      string(APPEND text "#include \"${file}\"\n")
    endforeach()
    set(joined ${CMAKE_CURRENT_BINARY_DIR}/${prefix}_${part}.cpp)
    file(CONFIGURE OUTPUT ${joined} CONTENT "${text}" @ONLY)
    target_sources(${library} PRIVATE ${joined})
    set(${part}_file ${joined})
  endforeach()
  set_source_files_properties(${fast_file} PROPERTIES COMPILE_OPTIONS "${BRICK_RTL_OPT}")
  set_source_files_properties(${slow_file} PROPERTIES COMPILE_OPTIONS "${BRICK_RTL_SLOW_OPT}")
endfunction()

# brick_add_rtl_shell(macro_ic_rtl SOURCES rtl_macro_ic.cpp LIBRARIES brick_core): a library of shells
# (testbench/unit/rtl/verilated_shell.h), then for each module that they hold
# brick_add_rtl_module(macro_ic_rtl TOP macro_ic [SOURCES a.sv] [PREFIX Vmacro_ic] [ARGS ...]): Verilated with lint.
function(brick_add_rtl_shell library)
  cmake_parse_arguments(S "" "" "SOURCES;LIBRARIES" ${ARGN})
  add_library(${library} STATIC ${S_SOURCES})
  set_source_files_properties(${S_SOURCES} PROPERTIES COMPILE_OPTIONS "${BRICK_WARNINGS}")  # generated code is not ours
  if(BRICK_COVERAGE)
    target_compile_definitions(${library} PRIVATE BRICK_RTL_COVERAGE=1)
  endif()
  target_link_libraries(${library} PUBLIC ${S_LIBRARIES})
endfunction()
function(brick_add_rtl_module library)
  cmake_parse_arguments(M "" "TOP;PREFIX" "SOURCES;ARGS" ${ARGN})
  if(NOT M_PREFIX)
    set(M_PREFIX V${M_TOP})
  endif()
  brick_verilate(${library} TOP ${M_TOP} PREFIX ${M_PREFIX} CONFIG ${BRICK_RTL}/lint.vlt SOURCES ${M_SOURCES}
    ARGS -Wall ${M_ARGS})
endfunction()
