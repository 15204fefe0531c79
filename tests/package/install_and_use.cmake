# Installs the library, builds the examples against what was installed, and runs one.
# cmake -D BUILD=... -D SOURCE=... -D CXX=... -P install_and_use.cmake
set(work ${BUILD}/package_test)
file(REMOVE_RECURSE ${work})
function(step)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE failed OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(failed)
    message(FATAL_ERROR "${ARGN}\n${text}")
  endif()
endfunction()
step(${CMAKE_COMMAND} --install ${BUILD} --prefix ${work}/prefix)
step(${CMAKE_COMMAND} -S ${SOURCE}/examples -B ${work}/build -G Ninja -DCMAKE_BUILD_TYPE=Release
  -DCMAKE_PREFIX_PATH=${work}/prefix -DCMAKE_CXX_COMPILER=${CXX})
step(${CMAKE_COMMAND} --build ${work}/build)
step(${work}/build/make_cage ${SOURCE}/samples/creature.obj ${work}/cage.obj)
step(${work}/prefix/bin/cagewright check ${SOURCE}/samples/creature.obj ${work}/cage.obj)
