# cpp-httplib by pkg-config: cpp-httplib_FOUND and the target PkgConfig::cpp-httplib.
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
  pkg_check_modules(cpp-httplib QUIET IMPORTED_TARGET GLOBAL cpp-httplib)
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(cpp-httplib REQUIRED_VARS cpp-httplib_LINK_LIBRARIES VERSION_VAR
                                                            cpp-httplib_VERSION)
