# p4est, with the sc library below it and MPI, whose C header wants its C++ library when C++ includes
# it: p4est_FOUND and the target p4est::p4est.
find_package(MPI QUIET COMPONENTS CXX)
find_path(P4EST_INCLUDE_DIR p8est.h)
find_library(P4EST_LIBRARY p4est)
find_library(SC_LIBRARY sc)
mark_as_advanced(P4EST_INCLUDE_DIR P4EST_LIBRARY SC_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(
  p4est REQUIRED_VARS P4EST_LIBRARY SC_LIBRARY P4EST_INCLUDE_DIR MPI_CXX_FOUND)

if(p4est_FOUND AND NOT TARGET p4est::p4est)
  if(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL)
    add_library(p4est::p4est UNKNOWN IMPORTED GLOBAL)
  else()
    add_library(p4est::p4est UNKNOWN IMPORTED)
  endif()
  set_target_properties(
    p4est::p4est PROPERTIES IMPORTED_LOCATION ${P4EST_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES
                                                               ${P4EST_INCLUDE_DIR})
  target_link_libraries(p4est::p4est INTERFACE ${SC_LIBRARY} MPI::MPI_CXX)
endif()
