# The one library, libnestgrid: static, or shared with BUILD_SHARED_LIBS=ON. Components add their
# objects to it. Link nestgrid::nestgrid or a component, which bring it along.
function(nestgrid_library)
  add_library(nestgrid_library)
  # A shared library finds those it depends on beside itself.
  set_target_properties(
    nestgrid_library
    PROPERTIES OUTPUT_NAME nestgrid VERSION ${PROJECT_VERSION} SOVERSION 0 EXPORT_NAME library
               LINKER_LANGUAGE CXX INSTALL_RPATH
               "$<IF:$<PLATFORM_ID:Darwin>,@loader_path,$ORIGIN>")
  add_library(nestgrid::library ALIAS nestgrid_library)
  nestgrid_install_component(library)
endfunction()

# nestgrid_component(<name> [HEADERS ...] [PARTS ...] [SOURCES ...] [PRIVATE_INCLUDES <folder> ...]
#                    [DEPENDS <component> ...] [LINK <target> ...]
#                    [PACKAGES "<find_package arguments>" ...] [FIND_MODULES <file> ...]
#                    [COMPLETED_BY <file>])
#
# Makes the target nestgrid::<name>, in the tree and installed. Each component is an include root of
# its own, so a component sees the headers of those it depends on and no others. PARTS are headers
# that one of HEADERS includes at its end; alone they do not compile. SOURCES become
# objects of libnestgrid; they alone see PRIVATE_INCLUDES. Without SOURCES the component is
# header-only. PACKAGES are found again by whoever asks the installed package for the component,
# with FIND_MODULES where they bring none of their own. COMPLETED_BY is included wherever the target is
# made, in the tree and by users, with nestgrid_target naming it: for what depends on their machine.
function(nestgrid_component name)
  cmake_parse_arguments(
    PARSE_ARGV 1 arg "" "COMPLETED_BY" "HEADERS;PARTS;SOURCES;PRIVATE_INCLUDES;DEPENDS;LINK;PACKAGES;FIND_MODULES")
  set(target nestgrid_${name})
  add_library(${target} INTERFACE)
  add_library(nestgrid::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  # To a parent project its own warnings matter, not ours, as with the installed package.
  if(NOT PROJECT_IS_TOP_LEVEL)
    set_target_properties(${target} PROPERTIES SYSTEM ON)
  endif()
  target_compile_features(${target} INTERFACE cxx_std_20)
  if(arg_SOURCES)
    list(PREPEND arg_DEPENDS library)
    nestgrid_objects(${target} "${arg_SOURCES}" "${arg_PRIVATE_INCLUDES}")
  endif()
  foreach(dependency IN LISTS arg_DEPENDS)
    target_link_libraries(${target} INTERFACE nestgrid::${dependency})
  endforeach()
  target_link_libraries(${target} INTERFACE ${arg_LINK})
  file(GLOB_RECURSE forgotten RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} nestgrid/*.h nestgrid/*.hpp)
  list(REMOVE_ITEM forgotten ${arg_HEADERS} ${arg_PARTS})
  if(forgotten)
    message(FATAL_ERROR "nestgrid: headers that component ${name} does not list: ${forgotten}")
  endif()
  if(arg_HEADERS)
    target_sources(${target} INTERFACE FILE_SET HEADERS BASE_DIRS ${CMAKE_CURRENT_SOURCE_DIR} FILES
                                       ${arg_HEADERS})
    set_target_properties(${target} PROPERTIES INTERFACE_HEADER_SETS_TO_VERIFY HEADERS)
    if(NESTGRID_BUILD_TESTS AND NOT CMAKE_CXX_CLANG_TIDY)
      set_target_properties(${target} PROPERTIES VERIFY_INTERFACE_HEADER_SETS ON)
    endif()
  endif()
  set(file_sets HEADERS)
  if(arg_PARTS)
    list(APPEND file_sets parts)
    target_sources(${target} INTERFACE FILE_SET parts TYPE HEADERS BASE_DIRS
                                       ${CMAKE_CURRENT_SOURCE_DIR} FILES ${arg_PARTS})
  endif()
  nestgrid_install_component(
    ${name} FILE_SETS ${file_sets} DEPENDS ${arg_DEPENDS} PACKAGES ${arg_PACKAGES} FIND_MODULES
                                                                   ${arg_FIND_MODULES}
    COMPLETED_BY ${arg_COMPLETED_BY})
  if(arg_COMPLETED_BY)
    set(nestgrid_target ${target})
    include(${CMAKE_CURRENT_SOURCE_DIR}/${arg_COMPLETED_BY})
  endif()
endfunction()

# Compiles sources into libnestgrid that include what users of the component do.
function(nestgrid_objects target sources private_includes)
  set(objects ${target}_objects)
  add_library(${objects} OBJECT ${sources})
  # What the headers declare is all there for users, whatever a parent project hides of its own.
  set_target_properties(${objects} PROPERTIES CXX_VISIBILITY_PRESET default VISIBILITY_INLINES_HIDDEN
                                                                            OFF)
  target_compile_options(${objects} PRIVATE -fvisibility=default -fno-visibility-inlines-hidden)
  # Objects in an archive serve any compiler: those of g++ hold machine code beside what its linker
  # optimises, those of clang hold one of the two.
  get_target_property(kind nestgrid_library TYPE)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(
      ${objects} PRIVATE $<$<BOOL:${CMAKE_INTERPROCEDURAL_OPTIMIZATION}>:-ffat-lto-objects>)
  elseif(kind STREQUAL "STATIC_LIBRARY")
    set_target_properties(${objects} PROPERTIES INTERPROCEDURAL_OPTIMIZATION OFF)
  endif()
  # A module of WebAssembly has no other place.
  if(NOT EMSCRIPTEN)
    set_target_properties(${objects} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  endif()
  target_compile_features(${objects} PRIVATE cxx_std_20)
  nestgrid_warnings(${objects})
  # Products and sums are rounded one by one, so that results are equal to the last bit on all
  # machines.
  target_compile_options(${objects} PRIVATE -ffp-contract=off)
  # Not linked, for the component links the library, and the library is made of the objects.
  target_include_directories(
    ${objects} PRIVATE $<TARGET_PROPERTY:${target},INTERFACE_INCLUDE_DIRECTORIES>
                       ${private_includes})
  target_compile_definitions(
    ${objects} PRIVATE $<TARGET_PROPERTY:${target},INTERFACE_COMPILE_DEFINITIONS>)
  target_sources(nestgrid_library PRIVATE $<TARGET_OBJECTS:${objects}>)
endfunction()

# nestgrid_install_component(<name> [FILE_SETS ...] [DEPENDS ...] [PACKAGES ...] [FIND_MODULES ...]
#                            [COMPLETED_BY <file>])
function(nestgrid_install_component name)
  if(NOT NESTGRID_INSTALL)
    return()
  endif()
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "COMPLETED_BY" "FILE_SETS;DEPENDS;PACKAGES;FIND_MODULES")
  set(headers "")
  foreach(file_set IN LISTS arg_FILE_SETS)
    list(APPEND headers FILE_SET ${file_set})
  endforeach()
  install(TARGETS nestgrid_${name} EXPORT nestgrid-${name}-targets ${headers})
  install(
    EXPORT nestgrid-${name}-targets
    NAMESPACE nestgrid::
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/nestgrid)
  # What the installed package needs to know of the component.
  set(text "set(nestgrid_${name}_depends ${arg_DEPENDS})\n")
  set(packages "")
  foreach(package IN LISTS arg_PACKAGES)
    string(APPEND packages "nestgrid_find(${name} ${package})\n")
  endforeach()
  if(arg_FIND_MODULES)
    set(packages "list(PREPEND CMAKE_MODULE_PATH \${CMAKE_CURRENT_LIST_DIR})\n${packages}"
                 "list(POP_FRONT CMAKE_MODULE_PATH)\n")
    string(CONCAT packages ${packages})
  endif()
  if(arg_COMPLETED_BY)
    install(
      FILES ${arg_COMPLETED_BY}
      DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/nestgrid
      RENAME nestgrid-${name}-completed.cmake)
  endif()
  file(WRITE ${PROJECT_BINARY_DIR}/package/nestgrid-${name}-depends.cmake "${text}")
  file(WRITE ${PROJECT_BINARY_DIR}/package/nestgrid-${name}-packages.cmake "${packages}")
  install(FILES ${PROJECT_BINARY_DIR}/package/nestgrid-${name}-depends.cmake
                ${PROJECT_BINARY_DIR}/package/nestgrid-${name}-packages.cmake ${arg_FIND_MODULES}
          DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/nestgrid)
endfunction()

# nestgrid_optional(<name> <package> [<more find_package arguments> ...])
#
# Defines the option NESTGRID_<NAME>: ON demands the package, OFF leaves the component <name> out,
# AUTO builds it where the package is found. Sets nestgrid_<name>_wanted.
function(nestgrid_optional name package)
  string(TOUPPER NESTGRID_${name} option)
  set(${option} AUTO CACHE STRING "The component ${name}, which needs ${package}: AUTO, ON or OFF")
  set_property(CACHE ${option} PROPERTY STRINGS AUTO ON OFF)
  set(wanted FALSE)
  if(${option} STREQUAL AUTO)
    find_package(${package} ${ARGN} QUIET)
    set(wanted ${${package}_FOUND})
    if(NOT wanted)
      message(STATUS "nestgrid: ${package} not found, the component '${name}' is left out")
    endif()
  elseif(${option})
    find_package(${package} ${ARGN} REQUIRED)
    set(wanted TRUE)
  endif()
  set(nestgrid_${name}_wanted ${wanted} PARENT_SCOPE)
endfunction()

# The warnings of our own programs, tests and compiled components. -Wrestrict of g++ 12 sees overlaps
# in every sum of strings (GCC bug 105651).
function(nestgrid_warnings target)
  target_compile_options(
    ${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow $<$<COMPILE_LANGUAGE:CXX>:-Wconversion>
                      $<$<AND:$<CXX_COMPILER_ID:GNU>,$<NOT:$<BOOL:${CMAKE_CXX_CLANG_TIDY}>>>:-Wno-restrict>
                      # What is private to a source stands in one file with others.
                      $<$<AND:$<COMPILE_LANG_AND_ID:CXX,GNU>,$<BOOL:${CMAKE_UNITY_BUILD}>>:-Wno-subobject-linkage>
                      $<$<AND:$<COMPILE_LANG_AND_ID:CXX,Clang>,$<BOOL:${CMAKE_UNITY_BUILD}>>:-Wno-shadow>
                      $<$<BOOL:${NESTGRID_WERROR}>:-Werror>)
endfunction()

# nestgrid_on_ranks(<test>...): tests that run ranks of MPI, as root, and more of them than processors.
# Ranks that wait leave the processor to others.
function(nestgrid_on_ranks)
  set_tests_properties(
    ${ARGN}
    PROPERTIES
      LABELS "distributed;mpi"
      PROCESSORS 2
      ENVIRONMENT
      "OMPI_ALLOW_RUN_AS_ROOT=1;OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1;OMPI_MCA_rmaps_base_oversubscribe=1;OMPI_MCA_mpi_yield_when_idle=1")
endfunction()

# nestgrid_ranks_test(<name> <ranks> <seconds> <command>): a command on so many ranks.
function(nestgrid_ranks_test name ranks timeout)
  add_test(NAME ${name} COMMAND ${MPIEXEC_EXECUTABLE} ${MPIEXEC_NUMPROC_FLAG} ${ranks} ${ARGN})
  nestgrid_on_ranks(${name})
  set_tests_properties(${name} PROPERTIES TIMEOUT ${timeout})
endfunction()


function(nestgrid_install_package)
  include(CMakePackageConfigHelpers)
  # What a compiler of C does not link of its own accord, and an archive needs.
  set(nestgrid_cxx_libraries ${CMAKE_CXX_IMPLICIT_LINK_LIBRARIES})
  list(REMOVE_ITEM nestgrid_cxx_libraries ${CMAKE_C_IMPLICIT_LINK_LIBRARIES})
  get_target_property(kind nestgrid_library TYPE)
  if(NOT kind STREQUAL "STATIC_LIBRARY")
    set(nestgrid_cxx_libraries "")
  endif()
  nestgrid_install_pkg_config()
  set(destination ${CMAKE_INSTALL_LIBDIR}/cmake/nestgrid)
  configure_package_config_file(
    ${PROJECT_SOURCE_DIR}/interface/cmake/nestgrid-config.cmake.in
    ${PROJECT_BINARY_DIR}/package/nestgrid-config.cmake INSTALL_DESTINATION ${destination})
  write_basic_package_version_file(
    ${PROJECT_BINARY_DIR}/package/nestgrid-config-version.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${PROJECT_BINARY_DIR}/package/nestgrid-config.cmake
                ${PROJECT_BINARY_DIR}/package/nestgrid-config-version.cmake
          DESTINATION ${destination})
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
endfunction()

# Writes nestgrid.pc, which finds what was installed with it wherever both are moved to.
function(nestgrid_install_pkg_config)
  set(folder ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
  set(nestgrid_includes ${CMAKE_INSTALL_INCLUDEDIR})
  set(nestgrid_libraries ${CMAKE_INSTALL_LIBDIR})
  foreach(name includes libraries)
    if(NOT IS_ABSOLUTE "${nestgrid_${name}}" AND NOT IS_ABSOLUTE "${folder}")
      file(RELATIVE_PATH up "/${folder}" "/")
      string(REGEX REPLACE "/$" "" up "${up}")
      set(nestgrid_${name} "\${pcfiledir}/${up}/${nestgrid_${name}}")
    elseif(NOT IS_ABSOLUTE "${nestgrid_${name}}")
      set(nestgrid_${name} "${CMAKE_INSTALL_PREFIX}/${nestgrid_${name}}")
    endif()
  endforeach()
  string(TOUPPER "CMAKE_${CMAKE_BUILD_TYPE}_POSTFIX" postfix)
  set(nestgrid_name "nestgrid${${postfix}}")
  set(nestgrid_definitions "")
  if(NESTGRID_WIDE_KEYS)
    set(nestgrid_definitions " -DNESTGRID_WIDE_KEYS")
  endif()
  list(TRANSFORM nestgrid_cxx_libraries PREPEND " -l")
  string(CONCAT nestgrid_cxx_libraries ${nestgrid_cxx_libraries})
  configure_file(${PROJECT_SOURCE_DIR}/interface/cmake/nestgrid.pc.in
                 ${PROJECT_BINARY_DIR}/package/nestgrid.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/package/nestgrid.pc DESTINATION ${folder})
endfunction()
