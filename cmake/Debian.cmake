# Debian packages of a finished build: cpack -G DEB. `brick` is what people run, `brick-dev` what designs of others link
# and build with. tools/packages.py makes and tries them.
set(CPACK_PACKAGE_NAME brick)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
# The project has no address of mail (SECURITY.md), and the format wants one: that domain reaches nobody (RFC 2606).
set(BRICK_CONTACT "The brick project <nobody@brick.invalid>")
set(CPACK_PACKAGE_CONTACT ${BRICK_CONTACT})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_COMPONENTS_ALL Unspecified debian package brick_sources debian_dev)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_BRICK_PACKAGE_NAME brick)
set(CPACK_DEBIAN_BRICK_PACKAGE_SECTION electronics)
set(CPACK_DEBIAN_BRICK_PACKAGE_SUGGESTS "gtkwave, gnuplot-nox")
set(CPACK_DEBIAN_DEV_PACKAGE_NAME brick-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "brick (= ${PROJECT_VERSION}), libsystemc-dev, libfmt-dev, python3")

set(about "virtual Turbo PMAC2 / Geo Brick LV motion controller")
string(CONCAT text "A motion controller down to every pin and every clock tick, as Verilated RTL,\n"
       "as a SystemC model or both, with its firmware and motors at its pins.")
set(CPACK_DEBIAN_BRICK_DESCRIPTION "${about}\n${text}")
string(CONCAT CPACK_DEBIAN_DEV_DESCRIPTION "${about} - components\n${text}\n"
       "These are its SystemC components, RTL and firmware sources, and examples.")

# Man page, completion, and what Debian wants in each package: licence and changelog.
set(debian ${CMAKE_BINARY_DIR}/debian)
file(MAKE_DIRECTORY ${debian})
find_program(GZIP gzip REQUIRED)
file(WRITE ${debian}/changelog "brick (${PROJECT_VERSION}) unstable; urgency=low\n\n  * See CHANGELOG.md.\n\n"
     " -- ${BRICK_CONTACT}  Tue, 24 Nov 2026 00:00:00 +0000\n")
file(WRITE ${debian}/copyright "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\n"
     "Upstream-Name: brick\n\nFiles: *\nCopyright: 2026 The brick project\nLicense: Apache-2.0\n"
     " On Debian systems, the full text is in /usr/share/common-licenses/Apache-2.0.\n"
     "Comment:\n What is linked statically stands with version and licence in\n"
     " /usr/share/brick/licences/brick.spdx.json, the texts beside it.\n")
foreach(file ${debian}/changelog ${CMAKE_SOURCE_DIR}/cmake/debian/brick.1)
  get_filename_component(name ${file} NAME)
  execute_process(COMMAND ${GZIP} -9nc ${file} OUTPUT_FILE ${debian}/${name}.gz)
endforeach()
install(FILES ${debian}/brick.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT debian)
install(FILES cmake/debian/brick.lintian DESTINATION share/lintian/overrides RENAME brick COMPONENT debian)
install(FILES cmake/debian/brick.bash DESTINATION share/bash-completion/completions RENAME brick COMPONENT debian)
foreach(pair "debian brick" "debian_dev brick-dev")
  separate_arguments(pair)
  list(GET pair 0 component)
  list(GET pair 1 package)
  install(FILES ${debian}/copyright ${debian}/changelog.gz DESTINATION share/doc/${package} COMPONENT ${component})
endforeach()
# The pages are those of brick, on which brick-dev depends. This is the last component of its group.
install(CODE "file(REMOVE_RECURSE \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/share/doc/brick\")"
  COMPONENT debian_dev EXCLUDE_FROM_ALL)
include(CPack)
cpack_add_component_group(brick)
cpack_add_component_group(dev)
cpack_add_component(Unspecified GROUP brick)
cpack_add_component(debian GROUP brick)
foreach(component package brick_sources debian_dev)
  cpack_add_component(${component} GROUP dev)
endforeach()
