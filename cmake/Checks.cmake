# Checks of the tree itself, as tests: lint of the RTL by three tools and of the Python, formatting, links, traces. A
# tool that is not installed makes its test "Skipped" (exit status 77), with the reason in the log; nothing else does.
# brick_add_check(NAME [NIGHT] FILE [ARGUMENTS]): with NIGHT, `ctest -C night` alone runs it.
function(brick_add_check name)
  cmake_parse_arguments(C "NIGHT" "" "" ${ARGN})
  set(when "")
  if(C_NIGHT)
    set(when CONFIGURATIONS night)
  endif()
  add_test(NAME ${name} ${when} COMMAND Python3::Interpreter ${C_UNPARSED_ARGUMENTS}
           WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
  set_tests_properties(${name} PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 300 LABELS check)
endfunction()

brick_add_check(lint.verilator tools/lint_rtl.py verilator)  # -Wall over every module as a top, waivers in rtl/lint.vlt
brick_add_check(lint.yosys tools/lint_rtl.py yosys)          # reads, elaborates and checks board_top
brick_add_check(lint.icarus tools/lint_rtl.py icarus)        # parses and elaborates board_top
brick_add_check(lint.unknowns tools/check_unknowns.py)       # four states in Icarus: no x from the end of a reset on
brick_add_check(lint.lists tools/rtl_cores.py --check)           # file lists and cores are the tree's, pages say so
brick_add_check(lint.lists_alone NIGHT tools/rtl_cores.py --elaborate)  # each list is all that its block needs
if(NOT BRICK_COVERAGE)  # coverage counters belong to an instance: nothing is shared then
  set(generated ${CMAKE_BINARY_DIR}/systemc/cosim/CMakeFiles/brick_rtl.dir)
  brick_add_check(lint.shared tools/check_shared.py ${generated}/Vboard_all.dir)
endif()
brick_add_check(lint.memory tools/area.py --memory)  # the dual-ported RAM is block RAM, not flip-flops
brick_add_check(lint.layers tools/check_layers.py)           # who may include whom, firmware and C++
brick_add_check(lint.names tools/check_names.py)             # a block's model, page, tests and proof have its name
brick_add_check(lint.cdc tools/check_cdc.py)                # nothing asynchronous feeds logic
brick_add_check(lint.outputs tools/check_outputs.py)        # no output has a glitch for who looks at any time
brick_add_check(lint.fpga tools/fpga.py --check)            # fpga/brick_ecp5.sv between real pads elaborates
brick_add_check(lint.python tools/lint_python.py)  # ruff, as pyproject.toml says
brick_add_check(format.clang tools/check_format.py clang)
brick_add_check(format.lines tools/check_format.py lines)
brick_add_check(lint.commits tools/check_commits.py)  # a commit that changes code says why
brick_add_check(pins.fresh rtl/pins/generate.py --check)  # what is made of the rows of pins, and board_top's ports
brick_add_check(docs.links tools/check_links.py)
brick_add_check(docs.figures tools/check_figures.py)
brick_add_check(docs.coverage tools/coverage.py --check)  # its form; rows stale or absent are named
brick_add_check(docs.mutation tools/mutate report --check)  # made of the results, no reason of a dead mutant
brick_add_check(mutation.planted tools/mutate planted --check)  # they apply, none was missed, docs/rules.md counts them
brick_add_check(docs.citations tools/check_citations.py)  # of the data sheet: each leads to a section, a rule
brick_add_check(trace.requirements tools/traceability.py)
brick_add_check(formal.joints tools/joints.py)  # each assumption of a proof names its guarantee
brick_add_check(docs.signoff tools/signoff.py)  # what stands behind each requirement; covers of the plan were counted
