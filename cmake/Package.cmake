# What other people's designs link: find_package(brick) with brick::systemc (components on the SystemC model) and
# brick::rtl (the engines with the Verilated RTL). Each is one library of all it needs of ours, so that the installed
# tree has nothing but it and the public headers; tools/check_package.py builds its examples against such a tree.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/brick)

# brick_add_package_library(systemc PARTS brick_board ... LIBRARIES PkgConfig::SYSTEMC)
function(brick_add_package_library name)
  cmake_parse_arguments(P "" "" "PARTS;LIBRARIES" ${ARGN})
  set(objects ${P_PARTS})
  foreach(part ${P_PARTS})
    target_compile_options(${part} PRIVATE -ffile-prefix-map=${CMAKE_SOURCE_DIR}/=)  # in reports and for debuggers
  endforeach()
  list(TRANSFORM objects REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>")
  add_library(brick_package_${name} STATIC ${objects})
  set_target_properties(brick_package_${name} PROPERTIES OUTPUT_NAME brick_${name} EXPORT_NAME ${name}
                                                         LINKER_LANGUAGE CXX)
  target_compile_features(brick_package_${name} INTERFACE cxx_std_17)
  target_link_libraries(brick_package_${name} INTERFACE ${P_LIBRARIES})
  install(TARGETS brick_package_${name} EXPORT brick_${name}
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT package
          INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endfunction()

brick_add_package_library(systemc
  PARTS brick_component brick_board brick_ssi brick_macro_ic brick_servo_ic brick_host_model brick_port_a
  LIBRARIES PkgConfig::SYSTEMC Threads::Threads)
brick_add_package_library(rtl
  PARTS brick_component_rtl brick_chips brick_cosim brick_rtl brick_verilated
  LIBRARIES brick_package_systemc fmt::fmt Threads::Threads)

# The examples that use it, and what builds all of them.
install(FILES examples/CMakeLists.txt DESTINATION ${CMAKE_INSTALL_DATADIR}/brick/examples COMPONENT package)
file(GLOB lists CONFIGURE_DEPENDS examples/*/CMakeLists.txt)
foreach(list ${lists})
  file(STRINGS ${list} uses REGEX "find_package\\(brick")
  if(uses)
    get_filename_component(example ${list} DIRECTORY)
    install(DIRECTORY ${example} DESTINATION ${CMAKE_INSTALL_DATADIR}/brick/examples COMPONENT package)
  endif()
endforeach()
foreach(name systemc rtl)
  install(EXPORT brick_${name} NAMESPACE brick:: DESTINATION ${package_dir} COMPONENT package)
endforeach()
install(DIRECTORY systemc/component/include/brick DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT package)
configure_package_config_file(cmake/brickConfig.cmake.in ${CMAKE_BINARY_DIR}/brickConfig.cmake
                              INSTALL_DESTINATION ${package_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/brickConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/brickConfig.cmake ${CMAKE_BINARY_DIR}/brickConfigVersion.cmake
        DESTINATION ${package_dir} COMPONENT package)
file(RELATIVE_PATH BRICK_PC_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)  # an installed tree may be moved
foreach(file brick brick-rtl)
  configure_file(cmake/${file}.pc.in ${CMAKE_BINARY_DIR}/${file}.pc @ONLY)
  install(FILES ${CMAKE_BINARY_DIR}/${file}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT package)
endforeach()

if(NOT BRICK_SANITIZE AND NOT BRICK_COVERAGE)  # a user's program knows nothing of their flags
  add_test(NAME package.programs  # an example by each pkg-config file
    COMMAND Python3::Interpreter tools/check_package.py --build ${CMAKE_BINARY_DIR} --compiler ${CMAKE_CXX_COMPILER}
            --programs WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
  add_test(NAME package.examples CONFIGURATIONS night  # all
    COMMAND Python3::Interpreter tools/check_package.py --build ${CMAKE_BINARY_DIR} --compiler ${CMAKE_CXX_COMPILER}
    WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
  set_tests_properties(package.programs package.examples PROPERTIES TIMEOUT 400 LABELS unit SKIP_RETURN_CODE 77)
endif()
