# Makes the folder of the page: our files in `source`, and those of three.js from npm, into `target`.
# Arguments: npm, source, target and `work`, a folder for packages.
cmake_minimum_required(VERSION 3.25)

# npm asks no network when the packages are there.
file(MAKE_DIRECTORY ${work})
set(lock ${source}/package-lock.json)
file(SHA256 ${lock} wanted)
set(installed "")
if(EXISTS ${work}/installed.txt)
  file(READ ${work}/installed.txt installed)
endif()
if(NOT installed STREQUAL wanted)
  file(COPY ${source}/package.json ${lock} DESTINATION ${work})
  execute_process(
    COMMAND ${npm} ci --omit=dev --ignore-scripts --no-audit --no-fund
    WORKING_DIRECTORY ${work}
    OUTPUT_VARIABLE log
    ERROR_VARIABLE log
    RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "npm could not install three.js for the page:\n${log}")
  endif()
  file(WRITE ${work}/installed.txt ${wanted})
endif()

file(REMOVE_RECURSE ${target})
file(GLOB ours ${source}/*.html ${source}/*.css ${source}/*.js)
file(COPY ${ours} DESTINATION ${target})
set(three ${work}/node_modules/three)
file(COPY ${three}/build/three.module.js ${three}/build/three.core.js DESTINATION ${target})
file(COPY_FILE ${three}/LICENSE ${target}/three.LICENSE)
# Browsers find modules by their file, not by the name of a package.
foreach(module controls/OrbitControls exporters/GLTFExporter)
  file(READ ${three}/examples/jsm/${module}.js text)
  string(REPLACE "from 'three';" "from './three.module.js';" text "${text}")
  cmake_path(GET module FILENAME name)
  file(WRITE ${target}/${name}.js "${text}")
endforeach()
