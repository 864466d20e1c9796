# Everything comes from Debian packages; ./dev installs them.
find_package(PkgConfig REQUIRED)
if(EXISTS ${CMAKE_SOURCE_DIR}/build/venv/bin/python3)  # ./dev makes it from tools/requirements.txt
  set(Python3_EXECUTABLE ${CMAKE_SOURCE_DIR}/build/venv/bin/python3)
endif()
find_package(Python3 REQUIRED COMPONENTS Interpreter)  # the scripts in tools/
pkg_check_modules(SYSTEMC REQUIRED IMPORTED_TARGET systemc)
find_package(verilator REQUIRED HINTS /usr/share/verilator)
find_package(GTest REQUIRED)
find_package(CLI11 REQUIRED)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(Threads REQUIRED)
find_path(ASIO_INCLUDE_DIR asio.hpp REQUIRED)  # sockets of the debugger's server and the Ethernet port
find_path(BOOST_INCLUDE_DIR boost/beast.hpp REQUIRED)  # websocket of the page, headers alone
pkg_check_modules(LIBEDIT REQUIRED IMPORTED_TARGET libedit)  # line editing of brick console
find_package(pugixml REQUIRED)  # JUnit's XML of brick regress
find_package(ZLIB REQUIRED)  # FST files
pkg_check_modules(TOMLPP REQUIRED IMPORTED_TARGET tomlplusplus)

# SystemC headers are not ours: no warnings from them.
add_library(brick_systemc INTERFACE)
add_library(brick_sc_main STATIC ${CMAKE_SOURCE_DIR}/systemc/core/sc_main.cpp)
target_include_directories(brick_sc_main SYSTEM PRIVATE ${SYSTEMC_INCLUDE_DIRS})
target_link_libraries(brick_systemc INTERFACE systemc brick_sc_main Threads::Threads)
target_include_directories(brick_systemc SYSTEM INTERFACE ${SYSTEMC_INCLUDE_DIRS})
