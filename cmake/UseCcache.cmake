# Compile through ccache where it is installed; the presets name this file. What includes a precompiled
# header is kept only by a ccache that is told not to ask which macros and times went into the header.
find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
    CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime ${CCACHE_PROGRAM}
    CACHE STRING "Compiler launcher")
endif()
