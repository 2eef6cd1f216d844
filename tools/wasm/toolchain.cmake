# WebAssembly by Emscripten, of Debian or of the variable EMSCRIPTEN_ROOT_PATH, with vectors of 16
# bytes and exceptions of the machine.
set(EMSCRIPTEN_ROOT_PATH /usr/share/emscripten CACHE PATH "The folder of Emscripten")
include(${EMSCRIPTEN_ROOT_PATH}/cmake/Modules/Platform/Emscripten.cmake)
set(machine "-msimd128 -fwasm-exceptions")
set(shim "-include ${CMAKE_CURRENT_LIST_DIR}/libcxx_13.hpp")
set(CMAKE_CXX_FLAGS_INIT "${machine} ${shim} -isystem ${CMAKE_BINARY_DIR}/include")
set(CMAKE_EXE_LINKER_FLAGS_INIT "${machine}")
# Boost's headers alone: the folder they are in has those of the system, too.
set(NESTGRID_BOOST_HEADERS /usr/include/boost CACHE PATH "The folder boost of headers")
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/include)
file(CREATE_LINK ${NESTGRID_BOOST_HEADERS} ${CMAKE_BINARY_DIR}/include/boost SYMBOLIC)
set(Boost_INCLUDE_DIR ${CMAKE_BINARY_DIR}/include CACHE PATH "")
