# What is installed beside the tools, and the Debian packages that cpack makes of it: hapsim (component
# tools), libhapsim0 (component library), libhapsim-dev (component dev) and, where the module is built,
# python3-hapsim (component python).
include(CMakePackageConfigHelpers)

# The library for CMake: find_package(hapsim), then hapsim::model and the like.
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/hapsim)
install(EXPORT hapsim NAMESPACE hapsim:: DESTINATION ${package} COMPONENT dev)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/hapsimConfig.cmake.in
  ${PROJECT_BINARY_DIR}/hapsimConfig.cmake INSTALL_DESTINATION ${package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/hapsimConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/hapsimConfig.cmake ${PROJECT_BINARY_DIR}/hapsimConfigVersion.cmake
  ${PROJECT_SOURCE_DIR}/cmake/HapsimDependencies.cmake DESTINATION ${package} COMPONENT dev)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/lib/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/hapsim COMPONENT dev
  FILES_MATCHING PATTERN "*.h" PATTERN assets EXCLUDE PATTERN lib/c EXCLUDE)

# ... and for pkg-config: every layer, those that use others first.
get_property(layers GLOBAL PROPERTY hapsim_layers)
list(REVERSE layers)
list(TRANSFORM layers PREPEND -lhapsim_)
list(JOIN layers " " HAPSIM_PC_LAYERS)
# Foreign libraries without a description of their own for pkg-config, by name.
set(HAPSIM_PC_FOREIGN "")
foreach(path ${TET_LIBRARY} ${CHOLMOD_LIBRARY} ${LAPACK_LIBRARY} ${BLAS_LIBRARY} ${TEEM_LIBRARY}
    ${NIFTI_LIBRARY} ${GDCM_LIBRARIES})
  get_filename_component(library ${path} NAME_WE)
  string(REGEX REPLACE "^lib" " -l" library ${library})
  string(APPEND HAPSIM_PC_FOREIGN ${library})
endforeach()
file(RELATIVE_PATH HAPSIM_PC_UP /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(${PROJECT_SOURCE_DIR}/cmake/hapsim.pc.in ${PROJECT_BINARY_DIR}/hapsim.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/hapsim.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)

# The pipeline, and the examples that it and the tutorials run.
install(FILES ${PROJECT_SOURCE_DIR}/Makefile.pipeline DESTINATION ${CMAKE_INSTALL_DATADIR}/hapsim COMPONENT tools)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/share/examples ${PROJECT_SOURCE_DIR}/share/schemas DESTINATION ${CMAKE_INSTALL_DATADIR}/hapsim
  COMPONENT tools USE_SOURCE_PERMISSIONS)
install(FILES ${PROJECT_SOURCE_DIR}/README.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/hapsim COMPONENT tools)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME hapsim)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "models of soft objects from scans and presses")
set(CPACK_PACKAGE_CONTACT "hapsim maintainers <maintainers@hapsim.invalid>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL tools library dev)
if(HAPSIM_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS OFF)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/DebianFiles.cmake)
set(CPACK_HAPSIM_SOURCE ${PROJECT_SOURCE_DIR})
set(CPACK_HAPSIM_DATE ${HAPSIM_RELEASE_DATE})
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)

set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME hapsim)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SHLIBDEPS ON)
# The reference BLAS makes factorisation 2 to 6 times slower; Ipopt is loaded when it is needed.
set(CPACK_DEBIAN_TOOLS_PACKAGE_DEPENDS "libopenblas0-pthread, coinor-libipopt1v5")
set(CPACK_DEBIAN_TOOLS_PACKAGE_RECOMMENDS make)
set(CPACK_DEBIAN_TOOLS_DESCRIPTION "From a scan of a soft object and recordings of presses to a model that gives
 contact forces in real time, and that says which physical effect it lacks.")
set(CPACK_DEBIAN_DEV_PACKAGE_NAME libhapsim-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
# What HapsimDependencies.cmake looks for.
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libhapsim0 (= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}), libeigen3-dev, libfmt-dev, libboost-dev, libcgal-dev, libtet1.5-dev, libsuitesparse-dev, libopenblas0-pthread, libblas-dev, liblapack-dev, coinor-libipopt-dev, libcli11-dev, nlohmann-json3-dev, liborocos-kdl-dev, liburdfdom-dev, libconsole-bridge-dev, libgdcm-dev, libnifti2-dev, libteem-dev, libsqlite3-dev, libsodium-dev, libpugixml-dev, libmatio-dev, libhdf5-dev, zlib1g-dev, pkg-config")
set(CPACK_DEBIAN_DEV_DESCRIPTION "Headers and static libraries of hapsim, for C++ programs that read its bodies
 and models, identify, simulate and diagnose, for CMake and pkg-config; and the header hapsim.h for programs
 in C, which link libhapsim.so.")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libhapsim0)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
file(WRITE ${PROJECT_BINARY_DIR}/debian/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/debian/triggers)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS "libopenblas0-pthread, coinor-libipopt1v5")
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION "hapsim as a shared library with an interface of C: bodies, recordings and
 models, and what the tools do with them.")
if(HAPSIM_PYTHON)
  math(EXPR next_python "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-hapsim)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/lib)  # libhapsim.so.0 is of no package yet
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "libhapsim0 (= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}), python3 (>= 3.${Python_VERSION_MINOR}~), python3 (<< 3.${next_python}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_DESCRIPTION "The module hapsim of Python: identifies, simulates, compares and diagnoses
 contact forces of soft bodies, with arrays of numpy.")
endif()
include(CPack)

# `cmake --build build/PRESET --target sbom`: what the tools that are built there are made of.
add_custom_target(sbom
  COMMAND ${PROJECT_SOURCE_DIR}/cmake/sbom.sh ${PROJECT_BINARY_DIR}/bin ${PROJECT_VERSION}
    libeigen3-dev libcgal-dev libboost-dev libcli11-dev nlohmann-json3-dev libnanoflann-dev libtet1.5-dev
    > ${PROJECT_BINARY_DIR}/hapsim.cdx.json
  BYPRODUCTS ${PROJECT_BINARY_DIR}/hapsim.cdx.json VERBATIM)
