# Every foreign library, found once. share/install-deps.sh installs them on Debian 12.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(Threads REQUIRED)
find_package(CLI11 REQUIRED)
find_package(CGAL REQUIRED OPTIONAL_COMPONENTS Core)
find_package(nlohmann_json REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(IPOPT REQUIRED IMPORTED_TARGET ipopt)

find_library(TET_LIBRARY tet REQUIRED)
find_path(TET_INCLUDE_DIR tetgen.h REQUIRED)

find_library(CHOLMOD_LIBRARY cholmod REQUIRED)
find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
if(HAPSIM_BUILD_TESTS)
  find_package(GTest REQUIRED)
endif()
