# nestgrid_component(<name> [HEADERS ...] [SOURCES ...] [DEPENDS <component> ...] [LINK <target> ...]
#                    [PACKAGES "<find_package arguments>" ...])
#
# Makes the target nestgrid::<name>, in the tree and installed. Each component is an include root of
# its own, so a component sees the headers of those it depends on and no others. Without SOURCES it
# is header-only. PACKAGES are found again by whoever asks the installed package for the component.
function(nestgrid_component name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "HEADERS;SOURCES;DEPENDS;LINK;PACKAGES")
  set(target nestgrid_${name})
  if(arg_SOURCES)
    set(scope PUBLIC)
    add_library(${target} ${arg_SOURCES})
    set_target_properties(${target} PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION 0
                                               POSITION_INDEPENDENT_CODE ON)
    nestgrid_warnings(${target})
  else()
    set(scope INTERFACE)
    add_library(${target} INTERFACE)
  endif()
  add_library(nestgrid::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(${target} ${scope} cxx_std_20)
  foreach(dependency IN LISTS arg_DEPENDS)
    target_link_libraries(${target} ${scope} nestgrid::${dependency})
  endforeach()
  target_link_libraries(${target} ${scope} ${arg_LINK})
  if(arg_HEADERS)
    target_sources(${target} ${scope} FILE_SET HEADERS BASE_DIRS ${CMAKE_CURRENT_SOURCE_DIR} FILES
                                      ${arg_HEADERS})
    if(NESTGRID_BUILD_TESTS AND NOT CMAKE_CXX_CLANG_TIDY)
      set_target_properties(${target} PROPERTIES VERIFY_INTERFACE_HEADER_SETS ON)
    endif()
  endif()
  if(NESTGRID_INSTALL)
    install(TARGETS ${target} EXPORT nestgrid-${name}-targets FILE_SET HEADERS)
    install(
      EXPORT nestgrid-${name}-targets
      NAMESPACE nestgrid::
      DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/nestgrid)
    # What the installed package needs to know of the component.
    set(text "set(nestgrid_${name}_depends ${arg_DEPENDS})\n")
    set(packages "")
    foreach(package IN LISTS arg_PACKAGES)
      string(APPEND packages "find_dependency(${package})\n")
    endforeach()
    file(WRITE ${PROJECT_BINARY_DIR}/package/nestgrid-${name}-depends.cmake "${text}")
    file(WRITE ${PROJECT_BINARY_DIR}/package/nestgrid-${name}-packages.cmake "${packages}")
    install(FILES ${PROJECT_BINARY_DIR}/package/nestgrid-${name}-depends.cmake
                  ${PROJECT_BINARY_DIR}/package/nestgrid-${name}-packages.cmake
            DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/nestgrid)
  endif()
endfunction()

# The warnings of our own programs, tests and compiled components. -Wrestrict of g++ 12 sees overlaps
# in every sum of strings (GCC bug 105651).
function(nestgrid_warnings target)
  target_compile_options(
    ${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow $<$<COMPILE_LANGUAGE:CXX>:-Wconversion>
                      $<$<AND:$<CXX_COMPILER_ID:GNU>,$<NOT:$<BOOL:${CMAKE_CXX_CLANG_TIDY}>>>:-Wno-restrict>
                      $<$<BOOL:${NESTGRID_WERROR}>:-Werror>)
endfunction()

function(nestgrid_install_package)
  include(CMakePackageConfigHelpers)
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
