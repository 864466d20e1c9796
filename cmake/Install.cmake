# cmake --install build/release --prefix DIR: bin/brick, and in share/brick what it reads: firmware image, boards,
# plants, set-ups, wave views.
include(GNUInstallDirs)
set(BRICK_DATA_DIR ${CMAKE_INSTALL_DATADIR}/brick)
if(TARGET brick)
  install(TARGETS brick RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
if(TARGET firmware_turbo)
  install(FILES ${CMAKE_BINARY_DIR}/bin/turbo.elf DESTINATION ${BRICK_DATA_DIR})
endif()
install(DIRECTORY boards DESTINATION ${BRICK_DATA_DIR} FILES_MATCHING PATTERN *.toml)
install(DIRECTORY examples/plants examples/setups DESTINATION ${BRICK_DATA_DIR}
  FILES_MATCHING PATTERN *.toml PATTERN *.pmc)
install(DIRECTORY waves DESTINATION ${BRICK_DATA_DIR} FILES_MATCHING PATTERN *.gtkw PATTERN out EXCLUDE)
# What README and headers point to.
foreach(component Unspecified package)
  install(FILES CHANGELOG.md CITATION.cff CONTRIBUTING.md LICENSE README.md SECURITY.md
    DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT ${component})
  install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT ${component}
    FILES_MATCHING PATTERN *.md PATTERN *.svg PATTERN *.png)
endforeach()

# What is linked of other people: licences and a list in SPDX, known when the build is finished.
if(TARGET brick AND CMAKE_GENERATOR STREQUAL "Ninja" AND NOT BRICK_SANITIZE AND NOT BRICK_COVERAGE)
  set(licences ${Python3_EXECUTABLE} ${CMAKE_SOURCE_DIR}/tools/licences.py ${CMAKE_BINARY_DIR})
  foreach(pair "Unspecified ${BRICK_DATA_DIR}" "package ${CMAKE_INSTALL_DOCDIR}")
    separate_arguments(pair)
    list(GET pair 0 component)
    list(GET pair 1 place)
    list(JOIN licences "\" \"" command)
    install(CODE "execute_process(OUTPUT_QUIET RESULT_VARIABLE status
      COMMAND \"${command}\" \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${place}/licences\")
      if(NOT status MATCHES \"^(0|77)$\")  # 77: the command is not built
        message(FATAL_ERROR \"tools/licences.py: \${status}\")
      endif()" COMPONENT ${component})
  endforeach()
  add_test(NAME package.licences COMMAND ${licences})
  set_tests_properties(package.licences PROPERTIES TIMEOUT 300 LABELS check)
endif()

# What a design of others takes: RTL with its lists, cores and register maps; the firmware's sources; examples. None of
# it is built, so `cmake --install DIR --component brick_sources` needs no build.
install(DIRECTORY rtl DESTINATION ${BRICK_DATA_DIR} COMPONENT brick_sources
  FILES_MATCHING REGEX "\\.(sv|f|core|vlt|rdl|pins|xml|h|hpp)$" PATTERN __pycache__ EXCLUDE)
install(DIRECTORY firmware DESTINATION ${BRICK_DATA_DIR} COMPONENT brick_sources
  FILES_MATCHING REGEX "\\.(c|h|S|ld|def)$")
install(DIRECTORY examples DESTINATION ${BRICK_DATA_DIR} COMPONENT brick_sources USE_SOURCE_PERMISSIONS
  PATTERN __pycache__ EXCLUDE PATTERN build EXCLUDE PATTERN sim_build EXCLUDE)
