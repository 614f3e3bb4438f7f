# Finds ufbx, which reads FBX. Its sources are two files, ufbx.c and ufbx.h, which are compiled into
# supple::formats: those of the folder SUPPLE_UFBX_DIR, those that tools/get_ufbx.sh downloads, or those of the
# system. Otherwise the library of the system, as the target Ufbx::Ufbx.
set(SUPPLE_UFBX_DIR "" CACHE PATH
  "Folder with ufbx.c and ufbx.h, which read FBX; empty: build/ufbx of the source tree, or the system")
unset(Ufbx_SOURCE_DIR CACHE)  # the folder may be another one now
find_path(Ufbx_SOURCE_DIR ufbx.c HINTS ${SUPPLE_UFBX_DIR} ${PROJECT_SOURCE_DIR}/build/ufbx PATH_SUFFIXES ufbx)
find_path(Ufbx_INCLUDE_DIR ufbx.h HINTS ${Ufbx_SOURCE_DIR})
find_library(Ufbx_LIBRARY ufbx)
mark_as_advanced(Ufbx_SOURCE_DIR Ufbx_INCLUDE_DIR Ufbx_LIBRARY)
if(NOT Ufbx_SOURCE_DIR AND Ufbx_LIBRARY AND Ufbx_INCLUDE_DIR AND NOT TARGET Ufbx::Ufbx)
  add_library(Ufbx::Ufbx UNKNOWN IMPORTED)
  set_target_properties(Ufbx::Ufbx PROPERTIES IMPORTED_LOCATION ${Ufbx_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${Ufbx_INCLUDE_DIR})
endif()
