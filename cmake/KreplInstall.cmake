# Installation and export: find_package(krepl) gives krepl::krepl, pkg-config gives krepl.
include(CMakePackageConfigHelpers)

# Before 1.0 every minor version may change the binary interface.
set_target_properties(krepl PROPERTIES
  VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})

install(TARGETS krepl EXPORT kreplTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY include/krepl DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.hpp" PATTERN "*.h")

# A static library hands its own needs on to those who link it.
set(krepl_dependencies "find_dependency(TBB)")

set(krepl_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/krepl)
install(EXPORT kreplTargets NAMESPACE krepl:: DESTINATION ${krepl_package_dir})
configure_package_config_file(cmake/kreplConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/kreplConfig.cmake
  INSTALL_DESTINATION ${krepl_package_dir})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/kreplConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/kreplConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/kreplConfigVersion.cmake
  DESTINATION ${krepl_package_dir})

# pkg-config asks for oneTBB only when it links statically; a static-only build says so by always asking.
get_target_property(krepl_library_type krepl TYPE)
if(krepl_library_type STREQUAL "SHARED_LIBRARY")
  set(krepl_pc_requires "Requires.private: tbb")
else()
  set(krepl_pc_requires "Requires: tbb")
endif()
# ${pcfiledir} keeps the file right when the installed tree is moved.
file(RELATIVE_PATH krepl_pc_prefix
  ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
string(REGEX REPLACE "/$" "" krepl_pc_prefix ${krepl_pc_prefix})
configure_file(cmake/krepl.pc.in ${CMAKE_CURRENT_BINARY_DIR}/krepl.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/krepl.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
# A program beside a shared library finds it wherever the tree is moved; its own install rules are in apps/krepl.
if(TARGET krepl_program AND krepl_library_type STREQUAL "SHARED_LIBRARY")
  file(RELATIVE_PATH krepl_to_library ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
  set_target_properties(krepl_program PROPERTIES INSTALL_RPATH "$ORIGIN/${krepl_to_library}")
endif()
