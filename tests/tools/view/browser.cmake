# What the tests of pages share: volumes to look at, Chromium, and what drives it, from npm, in
# nestgrid_browser_packages.
set(nestgrid_browser_packages ${PROJECT_BINARY_DIR}/tests/tools/view)
find_program(NESTGRID_NODE NAMES node nodejs REQUIRED)
find_program(NESTGRID_CHROMIUM NAMES chromium chromium-browser REQUIRED)
if(TARGET make_bucky_balls)
  return()
endif()
add_executable(make_bucky_balls ${CMAKE_CURRENT_LIST_DIR}/make_bucky_balls.cpp)
target_link_libraries(make_bucky_balls PRIVATE nestgrid::interface)
target_include_directories(make_bucky_balls PRIVATE ${PROJECT_SOURCE_DIR}/docs/examples)
nestgrid_warnings(make_bucky_balls)

file(MAKE_DIRECTORY ${nestgrid_browser_packages})
set(listed ${CMAKE_CURRENT_LIST_DIR}/package.json ${CMAKE_CURRENT_LIST_DIR}/package-lock.json)
add_custom_command(
  OUTPUT ${nestgrid_browser_packages}/node_modules/.package-lock.json
  COMMAND ${CMAKE_COMMAND} -E copy ${listed} ${nestgrid_browser_packages}
  COMMAND ${NESTGRID_NPM} ci --ignore-scripts --no-audit --no-fund --silent
  WORKING_DIRECTORY ${nestgrid_browser_packages}
  DEPENDS ${listed}
  COMMENT "Installing what drives the browser")
add_custom_target(view_test_packages ALL
                  DEPENDS ${nestgrid_browser_packages}/node_modules/.package-lock.json)

# Beside the packages, where modules find them.
function(nestgrid_browser_modules)
  foreach(module ${ARGN})
    configure_file(${PROJECT_SOURCE_DIR}/tests/tools/view/${module}.mjs
                   ${nestgrid_browser_packages}/${module}.mjs COPYONLY)
  endforeach()
endfunction()
nestgrid_browser_modules(axe_test checks chromium detail_test keys_test opened_page)
configure_file(${PROJECT_SOURCE_DIR}/tools/view/page/frame.js ${nestgrid_browser_packages}/frame.js COPYONLY)
