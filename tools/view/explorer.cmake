# What answers the requests of the page, for the server and for WebAssembly.
if(TARGET nestgrid_explorer)
  return()
endif()

# Requests and frames, which the component view has, too.
set(frame_sources frame_reply.cpp request_entries.cpp surface_arrays.cpp)
list(TRANSFORM frame_sources PREPEND ${CMAKE_CURRENT_LIST_DIR}/)
add_library(nestgrid_frames OBJECT ${frame_sources})
target_link_libraries(nestgrid_frames PUBLIC nestgrid::algorithms)
target_compile_options(nestgrid_frames PRIVATE -ffp-contract=off)
if(NOT EMSCRIPTEN)
  set_target_properties(nestgrid_frames PROPERTIES POSITION_INDEPENDENT_CODE ON)
endif()
nestgrid_warnings(nestgrid_frames)

set(explorer_sources explored_field.cpp explorer.cpp frame_drawing.cpp
                     ../drawing/first_isovalue.cpp frame_request.cpp)
list(TRANSFORM explorer_sources PREPEND ${CMAKE_CURRENT_LIST_DIR}/)
add_library(nestgrid_explorer STATIC ${explorer_sources} $<TARGET_OBJECTS:nestgrid_frames>)
target_include_directories(nestgrid_explorer PUBLIC ${CMAKE_CURRENT_LIST_DIR} ${CMAKE_CURRENT_LIST_DIR}/..)
target_link_libraries(nestgrid_explorer PUBLIC nestgrid::nestgrid)
nestgrid_warnings(nestgrid_explorer)
