# Dune's grids with the MPI and the threads that their targets name without finding them: Dune_FOUND,
# and Dune's own targets. A project without C has MPI for C++ only, which takes the place of MPI::MPI_C.
get_property(Dune_languages GLOBAL PROPERTY ENABLED_LANGUAGES)
set(Dune_mpi CXX)
if("C" IN_LIST Dune_languages)
  list(PREPEND Dune_mpi C)
endif()
find_package(MPI QUIET COMPONENTS ${Dune_mpi})
find_package(Threads QUIET)
if(MPI_FOUND AND NOT TARGET MPI::MPI_C)
  add_library(MPI::MPI_C INTERFACE IMPORTED)
  target_link_libraries(MPI::MPI_C INTERFACE MPI::MPI_CXX)
endif()
foreach(module common geometry uggrid grid)
  find_package(dune-${module} QUIET)
endforeach()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(
  Dune REQUIRED_VARS dune-grid_DIR dune-uggrid_DIR dune-geometry_DIR dune-common_DIR MPI_FOUND
                     Threads_FOUND)
