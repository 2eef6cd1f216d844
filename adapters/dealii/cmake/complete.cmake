# Links one of deal.II's two builds, as deal_ii_setup_target() does: the one for debugging to what is
# built as Debug, else the other. The property NESTGRID_DEALII_BUILD of a target, DEBUG or RELEASE,
# says otherwise.
find_package(deal.II 9.4 REQUIRED QUIET HINTS /usr/share/cmake)
set(nestgrid_said $<TARGET_PROPERTY:NESTGRID_DEALII_BUILD>)
if(DEAL_II_BUILD_TYPE MATCHES "Debug")
  set(nestgrid_debug
      $<OR:$<STREQUAL:${nestgrid_said},DEBUG>,$<AND:$<STREQUAL:${nestgrid_said},>,$<CONFIG:Debug>>>)
else()
  set(nestgrid_debug 0)
endif()
target_include_directories(${nestgrid_target} SYSTEM INTERFACE "$<BUILD_INTERFACE:${DEAL_II_INCLUDE_DIRS}>")
target_compile_definitions(${nestgrid_target} INTERFACE "$<BUILD_INTERFACE:${DEAL_II_USER_DEFINITIONS}>"
                                                        "$<BUILD_INTERFACE:$<${nestgrid_debug}:DEBUG>>")
foreach(nestgrid_library IN LISTS DEAL_II_LIBRARIES_DEBUG)
  target_link_libraries(${nestgrid_target} INTERFACE "$<BUILD_INTERFACE:$<${nestgrid_debug}:${nestgrid_library}>>")
endforeach()
foreach(nestgrid_library IN LISTS DEAL_II_LIBRARIES_RELEASE)
  target_link_libraries(${nestgrid_target}
                        INTERFACE "$<BUILD_INTERFACE:$<$<NOT:${nestgrid_debug}>:${nestgrid_library}>>")
endforeach()
# GNU ld reads all of deal.II and what it needs, which takes it up to a minute.
include(CheckLinkerFlag)
check_linker_flag(CXX -fuse-ld=gold NESTGRID_LINKER_GOLD)
if(NESTGRID_LINKER_GOLD)
  target_link_options(${nestgrid_target} INTERFACE "$<BUILD_INTERFACE:-fuse-ld=gold>")
endif()
