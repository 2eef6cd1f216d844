# Compiles the module `nestgrid` once in the project that asks for it, by its own compiler: the target
# nestgrid::fortran_module.
get_property(NestgridFortran_languages GLOBAL PROPERTY ENABLED_LANGUAGES)
set(NestgridFortran_LANGUAGE FALSE)
if("Fortran" IN_LIST NestgridFortran_languages)
  set(NestgridFortran_LANGUAGE TRUE)
endif()
find_file(NestgridFortran_SOURCE nestgrid.f90 NO_DEFAULT_PATH
          PATHS ${CMAKE_CURRENT_LIST_DIR} "${PACKAGE_PREFIX_DIR}/share/nestgrid")
mark_as_advanced(NestgridFortran_SOURCE)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(
  NestgridFortran REQUIRED_VARS NestgridFortran_SOURCE NestgridFortran_LANGUAGE
  REASON_FAILURE_MESSAGE "give the project the language Fortran before find_package(nestgrid)")
if(NestgridFortran_FOUND AND NOT TARGET nestgrid_fortran_module)
  add_library(nestgrid_fortran_module STATIC EXCLUDE_FROM_ALL ${NestgridFortran_SOURCE})
  set_target_properties(
    nestgrid_fortran_module
    PROPERTIES Fortran_MODULE_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/nestgrid_fortran_module
               POSITION_INDEPENDENT_CODE ON)
  target_include_directories(nestgrid_fortran_module
                             PUBLIC ${CMAKE_CURRENT_BINARY_DIR}/nestgrid_fortran_module)
  # In nestgrid's own tree exports would follow the alias to a target that is not installed.
  if(NOT TARGET nestgrid_fortran)
    add_library(nestgrid::fortran_module ALIAS nestgrid_fortran_module)
  endif()
endif()
