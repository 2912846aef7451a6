# How every target of hapsim is made: one place for the flags.

# A program holds what it calls of the rooms it links, also where they are compiled whole, and equal
# functions once where the linker can tell them (of debug information it would take too much memory).
include(CheckLinkerFlag)
add_link_options(-Wl,--gc-sections)
check_linker_flag(CXX "-fuse-ld=gold;-Wl,--icf=safe" HAPSIM_LINKER_FOLDS)
if(HAPSIM_LINKER_FOLDS)
  add_link_options($<$<CONFIG:Release>:-fuse-ld=gold> $<$<CONFIG:Release>:-Wl,--icf=safe>)
endif()

# Everything serves programs and the shared library alike. What is hidden is called as directly as in a program
# by itself; the shared library shows what says so.
add_compile_options(-fPIC -fvisibility=hidden)

# hapsim_flags(<target>): a section for each function and object, and the warnings every file must pass.
# g++ 12 warns falsely where a literal is joined to a string: of overlapping copies, and, when <string> is
# precompiled, of sizes and bounds too.
function(hapsim_flags target)
  target_compile_options(${target} PRIVATE -ffunction-sections -fdata-sections
    -Wall -Wextra -Wpedantic -Wshadow -Wno-psabi -Wno-missing-field-initializers
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict> $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow>
    $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds>)
endfunction()

# hapsim_quick(<target>): what computes little in a release is optimised little, and compiles in two thirds
# of the time. Results are the same bytes: no option here lets a compiler change arithmetic.
function(hapsim_quick target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# What nearly every file includes, compiled once: half of the time of a typical file. A precompiled header
# brings the optimisation it was compiled with.
foreach(pch hapsim_pch hapsim_pch_quick)
  add_library(${pch} OBJECT ${CMAKE_CURRENT_LIST_DIR}/pch.cpp)
  target_link_libraries(${pch} PRIVATE Eigen3::Eigen fmt::fmt)
  target_precompile_headers(${pch} PRIVATE <algorithm> <array> <cmath> <functional> <limits> <map>
    <memory> <optional> <ostream> <string> <utility> <vector> <fmt/format.h>
    ${PROJECT_SOURCE_DIR}/lib/base/dense_decompositions.h)
  hapsim_flags(${pch})
endforeach()
hapsim_quick(hapsim_pch_quick)

# Rooms compiled as one unit each share what they instantiate of Eigen. Files then share one anonymous
# namespace, and one edit compiles a room: for builds that begin from nothing.
option(HAPSIM_WHOLE_ROOMS "Compile each room of lib, the tests of each and the Python module at once" OFF)

# hapsim_layer(<name> [APART] [QUICK] SOURCES a.cpp ... [CGAL b.cpp ...] [CGAL_QUICK c.cpp ...] USES layer ...
# [LINKS foreign ...]): a room of lib as a library; APART, always file by file; QUICK, see hapsim_quick. What
# stands under CGAL is compiled with its flags (-frounding-math), which nothing else is built with; users of
# the library see none of CGAL's headers, but GMP and MPFR must be linked. CGAL's files that instantiate the
# same templates share a UNITY_GROUP: each template is compiled once, and CGAL read once.
function(hapsim_layer name)
  cmake_parse_arguments(arg "APART;QUICK" "" "SOURCES;CGAL;CGAL_QUICK;USES;LINKS" ${ARGN})
  list(TRANSFORM arg_USES PREPEND hapsim_)
  foreach(kind CGAL CGAL_QUICK)
    if(NOT arg_${kind})
      continue()
    endif()
    string(TOLOWER hapsim_${name}_${kind} target)
    add_library(${target} OBJECT ${arg_${kind}})
    target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/lib)
    target_compile_definitions(${target} PRIVATE CGAL_EIGEN3_ENABLED)
    target_link_libraries(${target} PRIVATE ${arg_USES} CGAL::CGAL Eigen3::Eigen fmt::fmt)
    hapsim_flags(${target})
    # g++ 12 warns falsely inside CGAL.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
    list(APPEND arg_SOURCES $<TARGET_OBJECTS:${target}>)
  endforeach()
  if(arg_CGAL_QUICK)
    hapsim_quick(hapsim_${name}_cgal_quick)
  endif()
  add_library(hapsim_${name} STATIC ${arg_SOURCES})
  target_include_directories(hapsim_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/lib> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/hapsim>)
  target_link_libraries(hapsim_${name} PUBLIC ${arg_USES} PRIVATE ${arg_LINKS})
  if(arg_CGAL OR arg_CGAL_QUICK)
    target_link_libraries(hapsim_${name} INTERFACE $<LINK_ONLY:CGAL::CGAL>)
  endif()
  hapsim_flags(hapsim_${name})
  set(pch hapsim_pch)
  if(arg_QUICK)
    set(pch hapsim_pch_quick)
    hapsim_quick(hapsim_${name})
  endif()
  target_precompile_headers(hapsim_${name} REUSE_FROM ${pch})
  if(HAPSIM_WHOLE_ROOMS AND NOT arg_APART)
    set_target_properties(hapsim_${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
    # What is private to a file included here is private to it still.
    target_compile_options(hapsim_${name} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
  set_target_properties(hapsim_${name} PROPERTIES EXPORT_NAME ${name})
  set_property(GLOBAL APPEND PROPERTY hapsim_layers ${name})
  install(TARGETS hapsim_${name} EXPORT hapsim COMPONENT dev
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
endfunction()

# hapsim_module(<name> SOURCES a.cpp ... USES c): a room of lib as the module hapsim of Python, over libhapsim.so. It
# is installed where Debian's Python looks below /usr.
function(hapsim_module name)
  if(NOT HAPSIM_PYTHON)
    return()
  endif()
  cmake_parse_arguments(arg "" "" "SOURCES;USES" ${ARGN})
  pybind11_add_module(hapsim_${name} MODULE NO_EXTRAS ${arg_SOURCES})
  target_include_directories(hapsim_${name} PRIVATE ${PROJECT_SOURCE_DIR}/lib)
  target_link_libraries(hapsim_${name} PRIVATE hapsim_shared)
  hapsim_flags(hapsim_${name})
  if(HAPSIM_WHOLE_ROOMS)
    set_target_properties(hapsim_${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
  endif()
  set_target_properties(hapsim_${name} PROPERTIES OUTPUT_NAME hapsim
    LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/python)
  install(TARGETS hapsim_${name} LIBRARY DESTINATION lib/python3/dist-packages COMPONENT python)
endfunction()

# hapsim_tool(<name> USES layer ...): a command in tools/<name>.cpp, or of a folder of that name,
# installed with its man page.
function(hapsim_tool name)
  cmake_parse_arguments(arg "" "" "USES" ${ARGN})
  set(source ${PROJECT_SOURCE_DIR}/tools/${name}.cpp)
  if(NOT EXISTS ${source})
    set(source ${PROJECT_SOURCE_DIR}/tools/${name}/${name}.cpp)
  endif()
  add_executable(${name} ${source})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tools)
  list(TRANSFORM arg_USES PREPEND hapsim_)
  target_link_libraries(${name} PRIVATE hapsim_cli ${arg_USES})
  hapsim_flags(${name})
  hapsim_quick(${name})
  target_precompile_headers(${name} REUSE_FROM hapsim_pch_quick)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT tools)
  # Man page and completions: made by the tool, each where its shell looks for it on Debian.
  set(made "")
  foreach(item
      "man man/${name}.1 ${CMAKE_INSTALL_MANDIR}/man1"
      "completion-bash completions/${name} ${CMAKE_INSTALL_DATADIR}/bash-completion/completions"
      "completion-zsh completions/_${name} ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions"
      "completion-fish completions/${name}.fish ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d")
    separate_arguments(item)
    list(GET item 0 flag)
    list(GET item 1 file)
    list(GET item 2 folder)
    set(file ${PROJECT_BINARY_DIR}/${file})
    add_custom_command(OUTPUT ${file}
      COMMAND ${CMAKE_COMMAND} -E make_directory ${PROJECT_BINARY_DIR}/man ${PROJECT_BINARY_DIR}/completions
      COMMAND ${name} --${flag} > ${file} DEPENDS ${name} VERBATIM)
    install(FILES ${file} DESTINATION ${folder} COMPONENT tools)
    list(APPEND made ${file})
  endforeach()
  add_custom_target(man_${name} ALL DEPENDS ${made})
  set_property(GLOBAL APPEND PROPERTY hapsim_tools ${name})
endfunction()

# hapsim_test(<name> SOURCES x_test.cpp ... USES layer ... [how it runs]): one GoogleTest program, one ctest entry.
# What it computes with is in lib: it is quick itself.
function(hapsim_test name)
  cmake_parse_arguments(arg "THREADS;ALONE" "SECONDS" "SOURCES;USES" ${ARGN})
  add_executable(test_${name} ${arg_SOURCES})
  list(TRANSFORM arg_USES PREPEND hapsim_)
  target_link_libraries(test_${name} PRIVATE ${arg_USES} GTest::gtest_main)
  target_include_directories(test_${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(test_${name} PRIVATE
    HAPSIM_SOURCE_DIR="${PROJECT_SOURCE_DIR}" HAPSIM_BIN_DIR="${PROJECT_BINARY_DIR}/bin")
  hapsim_flags(test_${name})
  hapsim_quick(test_${name})
  target_precompile_headers(test_${name} REUSE_FROM hapsim_pch_quick)
  if(HAPSIM_WHOLE_ROOMS)
    set_target_properties(test_${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
  endif()
  add_test(NAME ${name} COMMAND test_${name})
  hapsim_run(${name} ${ARGN})
endfunction()

# hapsim_script(<name> <script> [ARGS argument ...] [how it runs]): a script of this folder as a ctest entry.
function(hapsim_script name script)
  cmake_parse_arguments(arg "THREADS;ALONE" "SECONDS" "ARGS" ${ARGN})
  add_test(NAME ${name} COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/${script} ${arg_ARGS})
  hapsim_run(${name} ${ARGN})
endfunction()

# hapsim_run(<name> [THREADS] [ALONE] [SECONDS n]): how ctest runs a test, and its label, which is the folder of
# tests that it stands in (`ctest -L cli`). THREADS: it keeps two processors busy. ALONE: it measures time or
# has to keep up with it. SECONDS: how long it takes; where nothing is on record yet the longest begin first.
function(hapsim_run name)
  cmake_parse_arguments(arg "THREADS;ALONE" "SECONDS" "" ${ARGN})
  file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR}/tests ${CMAKE_CURRENT_SOURCE_DIR})
  string(REGEX REPLACE "/.*" "" folder ${folder})
  set_tests_properties(${name} PROPERTIES LABELS ${folder} RUN_SERIAL ${arg_ALONE})
  if(arg_THREADS)
    set_tests_properties(${name} PROPERTIES PROCESSORS 2)
  endif()
  if(arg_SECONDS)
    set_tests_properties(${name} PROPERTIES COST ${arg_SECONDS})
  endif()
endfunction()
