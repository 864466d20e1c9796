# cmake --install build/release --prefix DIR: bin/brick, and in share/brick what it reads: firmware image, boards, wave
# views.
include(GNUInstallDirs)
set(BRICK_DATA_DIR ${CMAKE_INSTALL_DATADIR}/brick)
if(TARGET brick)
  install(TARGETS brick RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
if(TARGET firmware_turbo)
  install(FILES ${CMAKE_BINARY_DIR}/bin/turbo.elf DESTINATION ${BRICK_DATA_DIR})
endif()
install(DIRECTORY boards DESTINATION ${BRICK_DATA_DIR} FILES_MATCHING PATTERN *.toml)
install(DIRECTORY waves DESTINATION ${BRICK_DATA_DIR} FILES_MATCHING PATTERN *.gtkw PATTERN out EXCLUDE)
install(FILES LICENSE README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
