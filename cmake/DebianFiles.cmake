# Run by cpack for each package before it is closed: what Debian wants beside the program's own files.
foreach(pair tools:hapsim library:libhapsim0 dev:libhapsim-dev python:python3-hapsim)
  string(REPLACE ":" ";" pair ${pair})
  list(GET pair 0 component)
  list(GET pair 1 name)
  set(root ${CPACK_TEMPORARY_DIRECTORY}/${component})
  if(NOT EXISTS ${root})
    continue()
  endif()
  set(doc ${root}/usr/share/doc/${name})
  file(MAKE_DIRECTORY ${doc})
  file(WRITE ${doc}/copyright "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: hapsim

Files: *
Copyright: 2026 the authors of hapsim
License: AGPL-3.0-or-later
 hapsim is free software: you can redistribute it and/or modify it under the terms of the GNU Affero
 General Public License as published by the Free Software Foundation, either version 3 of the License, or
 (at your option) any later version.
 .
 It is distributed in the hope that it will be useful, but WITHOUT ANY WARRANTY; without even the implied
 warranty of MERCHANTABILITY or FITNESS FOR A PARTICULAR PURPOSE. See the GNU Affero General Public License
 for more details: <https://www.gnu.org/licenses/agpl-3.0>.
")
  execute_process(COMMAND date -R -u -d ${CPACK_HAPSIM_DATE} OUTPUT_VARIABLE date
    OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  file(WRITE ${doc}/changelog.Debian "hapsim (${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}) unstable; urgency=medium

  * The release of hapsim; changelog.gz says what is in it.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")
  file(READ ${CPACK_HAPSIM_SOURCE}/CHANGELOG.md changes)
  file(WRITE ${doc}/changelog ${changes})
  file(GLOB pages ${root}/usr/share/man/man*/*.[1-9])
  execute_process(COMMAND gzip -9nf ${doc}/changelog ${doc}/changelog.Debian ${pages} COMMAND_ERROR_IS_FATAL ANY)
  file(GLOB archives ${root}/usr/lib/*.a ${root}/usr/lib/*/*.a)
  if(archives)
    execute_process(COMMAND strip --strip-debug --remove-section=.comment --remove-section=.note ${archives}
      COMMAND_ERROR_IS_FATAL ANY)
  endif()
  execute_process(COMMAND chmod -R go=rX ${root}/usr)
endforeach()
