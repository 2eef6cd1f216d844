# Installs the build tree to a temporary prefix and builds a foreign project against it.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "'${ARGN}' failed:\n${text}")
  endif()
  set(said "${text}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${work})
run(${CMAKE_COMMAND} --install ${build} --prefix ${work}/prefix)
if(EXISTS ${work}/prefix/bin/nestgrid)
  foreach(text man/man1/nestgrid.1 bash-completion/completions/nestgrid zsh/site-functions/_nestgrid)
    file(SIZE ${work}/prefix/share/${text} size) # an error where it is not installed
    if(size LESS 10000)
      message(FATAL_ERROR "share/${text} has ${size} bytes")
    endif()
  endforeach()
endif()
set(configure ${CMAKE_COMMAND} -S ${source} -G ${generator} -D CMAKE_CXX_COMPILER=${compiler} -D
              CMAKE_CXX_FLAGS=${flags} -D CMAKE_PREFIX_PATH=${work}/prefix)
# Separated by commas: a list would come apart on its way to the command.
string(REPLACE ";" "," everything "${everything}")
foreach(components "" bisection "bisection,algorithms" "${everything}")
  string(MAKE_C_IDENTIFIER "build_${components}" folder)
  run(${configure} -B ${work}/${folder} -D components=${components})
  if(NOT components STREQUAL "bisection")
    run(${CMAKE_COMMAND} --build ${work}/${folder})
    run(${work}/${folder}/sphere)
    if(components MATCHES "dune")
      run(${work}/${folder}/ug)
    endif()
    if(components MATCHES "mpi" AND components MATCHES "p4est")
      # Root may start processes in containers; there may be fewer processors than ranks.
      run(${CMAKE_COMMAND} -E env OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
          ${mpiexec} --oversubscribe -n 4 ${work}/${folder}/p4est_ranks ${work}/surface.vtp)
      if(NOT said MATCHES "4 ranks, [0-9]+ triangles, 0 open edges")
        message(FATAL_ERROR "four ranks drew no closed surface: ${said}")
      endif()
    endif()
    if(components MATCHES "fortran")
      run(${work}/${folder}/fortran_grid)
    endif()
    if(components MATCHES "view")
      run(${work}/${folder}/page)
    endif()
  endif()
endforeach()

execute_process(
  COMMAND ${configure} -B ${work}/unknown -D components=teapot
  RESULT_VARIABLE status
  OUTPUT_QUIET
  ERROR_VARIABLE text)
if(status EQUAL 0 OR NOT text MATCHES "without the component 'teapot'")
  message(FATAL_ERROR "an unknown component was not refused with a sentence: ${text}")
endif()
