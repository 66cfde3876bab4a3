# cmake -DBUILD= -DPREFIX= -DSOURCE= -DMODEL= -DPYTHON= -DPACKAGES= -P run.cmake
# Installs the build tree into an empty folder, builds the consumer against it, runs it, and draws
# with the installed Python package.
set(consumer "${PREFIX}-consumer")
file(REMOVE_RECURSE "${PREFIX}" "${consumer}")

function(step)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN}\nended with ${result}:\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

step("${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${PREFIX}")
step("${CMAKE_COMMAND}" -G Ninja -S "${SOURCE}" -B "${consumer}" "-DDspace_ROOT=${PREFIX}"
  -DCMAKE_BUILD_TYPE=Debug)
step("${CMAKE_COMMAND}" --build "${consumer}")
step("${consumer}/consumer" "${MODEL}")
message(STATUS "${output}")
if(NOT output MATCHES "^[1-9][0-9]* triangles, picked model at ")
  message(FATAL_ERROR "the consumer printed: ${output}")
endif()
# Clients in other languages are made of the .proto files alone.
file(GLOB protos "${PREFIX}/share/dspace/proto/dspace/proto/*.proto")
file(MAKE_DIRECTORY "${consumer}/stubs")
step(protoc "-I${PREFIX}/share/dspace/proto" "--python_out=${consumer}/stubs" ${protos})
if(NOT EXISTS "${consumer}/stubs/dspace/proto/service_pb2.py")
  message(FATAL_ERROR "service.proto is not installed")
endif()
if(PYTHON)
  set(ENV{PYTHONPATH} "${PREFIX}/${PACKAGES}")
  set(ENV{PYTHONDONTWRITEBYTECODE} 1)
  step("${PYTHON}" "${SOURCE}/consumer.py" "${PREFIX}" "${MODEL}")
  message(STATUS "${output}")
  step("${CMAKE_COMMAND}" -G Ninja -S "${SOURCE}/../../Examples/cpp_client" -B "${consumer}/client"
    "-DDspace_ROOT=${PREFIX}" -DCMAKE_BUILD_TYPE=Debug)
  step("${CMAKE_COMMAND}" --build "${consumer}/client")
  step("${PYTHON}" -W ignore "${SOURCE}/client.py" "${consumer}/client/drive")
  message(STATUS "${output}")
  unset(ENV{PYTHONPATH}) # the command finds the package beside itself
  get_filename_component(data "${MODEL}" DIRECTORY)
  step("${PREFIX}/bin/dspace" terrain info "${data}/../field/field.tif")
  if(NOT output MATCHES "1001 x 1001 pixels of Float32")
    message(FATAL_ERROR "dspace terrain info printed: ${output}")
  endif()
endif()
