# TetGen as a library: TetGen_FOUND and the target TetGen::tet.
find_path(TETGEN_INCLUDE_DIR tetgen.h)
find_library(TETGEN_LIBRARY tet)
mark_as_advanced(TETGEN_INCLUDE_DIR TETGEN_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(TetGen REQUIRED_VARS TETGEN_LIBRARY TETGEN_INCLUDE_DIR)

if(TetGen_FOUND AND NOT TARGET TetGen::tet)
  if(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL)
    add_library(TetGen::tet UNKNOWN IMPORTED GLOBAL)
  else()
    add_library(TetGen::tet UNKNOWN IMPORTED)
  endif()
  set_target_properties(
    TetGen::tet
    PROPERTIES IMPORTED_LOCATION ${TETGEN_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES
                                                   ${TETGEN_INCLUDE_DIR}
               INTERFACE_COMPILE_DEFINITIONS TETLIBRARY)
endif()
