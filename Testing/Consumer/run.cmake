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
file(GLOB_RECURSE compiled "${PREFIX}/lib*/dspace/scene/__pycache__/scene.*.pyc"
  "${PREFIX}/lib*/dspace/proto/__pycache__/commands_pb2.*.pyc")
list(LENGTH compiled count)
if(NOT count EQUAL 2)
  message(FATAL_ERROR "the installed Python files are not compiled: ${compiled}")
endif()
step("${CMAKE_COMMAND}" -G Ninja -S "${SOURCE}" -B "${consumer}" "-DDspace_ROOT=${PREFIX}"
  -DCMAKE_BUILD_TYPE=Debug)
step("${CMAKE_COMMAND}" --build "${consumer}")
step("${consumer}/consumer" "${MODEL}")
message(STATUS "${output}")
if(NOT output MATCHES "^[1-9][0-9]* triangles, picked model at ")
  message(FATAL_ERROR "the consumer printed: ${output}")
endif()
# A program in process with terrain, a model, moving frames, a picture and a pick.
get_filename_component(data "${MODEL}" DIRECTORY)
step("${CMAKE_COMMAND}" -G Ninja -S "${SOURCE}/../../Examples/cpp_local" -B "${consumer}/local"
  "-DDspace_ROOT=${PREFIX}" -DCMAKE_BUILD_TYPE=Debug)
step("${CMAKE_COMMAND}" --build "${consumer}/local")
step("${consumer}/local/cpp_local" "${data}/../field/field.tif" "${MODEL}" "${consumer}/local.png")
message(STATUS "${output}")
if(NOT output MATCHES "^41 pictures, picked body and ground, whose .* differ by [0-9]([.][0-9e-]*)? mm"
    OR NOT EXISTS "${consumer}/local.png")
  message(FATAL_ERROR "cpp_local printed: ${output}")
endif()
# Viewports in a window of another program.
if(WIDGETS)
  step("${CMAKE_COMMAND}" -G Ninja -S "${SOURCE}/../../Examples/qt_embed" -B "${consumer}/embed"
    "-DDspace_ROOT=${PREFIX}" -DCMAKE_BUILD_TYPE=Debug)
  step("${CMAKE_COMMAND}" --build "${consumer}/embed")
  step("${SOURCE}/../Tools/with_display" "${consumer}/embed/qt_embed" "${MODEL}" 2)
  message(STATUS "${output}")
  if(NOT output MATCHES "[1-9][0-9]* steps, [1-9][0-9]+ pictures")
    message(FATAL_ERROR "qt_embed printed: ${output}")
  endif()
  # The installed application, with a plug-in in C++.
  step("${CMAKE_COMMAND}" -G Ninja -S "${SOURCE}/../../Examples/window_plugin" -B "${consumer}/plugin"
    "-DDspace_ROOT=${PREFIX}" -DCMAKE_BUILD_TYPE=Debug)
  step("${CMAKE_COMMAND}" --build "${consumer}/plugin")
  step("${SOURCE}/../Tools/with_display" "${PREFIX}/bin/DspaceQt" --screenshot "${consumer}/app.png"
    --load-plugin "${consumer}/plugin/libsun_clock.so" "${MODEL}")
  if(NOT EXISTS "${consumer}/app.png" OR output MATCHES "rror")
    message(FATAL_ERROR "DspaceQt printed: ${output}")
  endif()
  # Its demo, from the installed data alone.
  set(data_given "$ENV{DSPACE_SHIPPED_DATA}")
  unset(ENV{DSPACE_SHIPPED_DATA})
  step("${SOURCE}/../Tools/with_display" "${PREFIX}/bin/DspaceQt" --screenshot "${consumer}/demo.png")
  if(NOT EXISTS "${consumer}/demo.png" OR output MATCHES "rror")
    message(FATAL_ERROR "DspaceQt printed: ${output}")
  endif()
  set(ENV{DSPACE_SHIPPED_DATA} "${data_given}")
  # The files of the desktop: its menus, icons, kinds of files, the guide.
  step(desktop-file-validate "${PREFIX}/share/applications/dspace.desktop")
  step(xmllint --noout "${PREFIX}/share/mime/packages/dspace.xml" "${PREFIX}/share/icons/hicolor/scalable/apps/dspace.svg")
  step(update-mime-database "${PREFIX}/share/mime")
  file(READ "${PREFIX}/share/mime/globs2" globs)
  if(NOT globs MATCHES "80:application/x-dspace-recording:[*].dspace")
    message(FATAL_ERROR "the kind of recordings is not known: ${globs}")
  endif()
  foreach(size 16 24 32 48 64 128 256 512)
    # Width and height of a PNG are its bytes 16 to 23.
    file(READ "${PREFIX}/share/icons/hicolor/${size}x${size}/apps/dspace.png" sides OFFSET 16 LIMIT 8 HEX)
    string(SUBSTRING "${sides}" 0 8 wide)
    string(SUBSTRING "${sides}" 8 8 high)
    math(EXPR wide "0x${wide}")
    math(EXPR high "0x${high}")
    if(NOT wide EQUAL size OR NOT high EQUAL size)
      message(FATAL_ERROR "the icon of ${size} pixels has ${wide} x ${high}")
    endif()
  endforeach()
  if(NOT EXISTS "${PREFIX}/share/doc/dspace/Application.md")
    message(FATAL_ERROR "the guide is not installed")
  endif()
endif()
# A plug-in with an object of its own.
step("${CMAKE_COMMAND}" -G Ninja -S "${SOURCE}/../../Examples/own_object" -B "${consumer}/own"
  "-DDspace_ROOT=${PREFIX}" -DCMAKE_BUILD_TYPE=Debug)
step("${CMAKE_COMMAND}" --build "${consumer}/own")
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
  step("${PYTHON}" "${SOURCE}/../../Examples/own_object/own_object.py" "${consumer}/own/libsolar_sail.so"
    "${consumer}/own.png")
  message(STATUS "${output}")
  step("${PYTHON}" "${SOURCE}/own_object.py" "${consumer}/own/libsolar_sail.so" "${consumer}")
  step("${CMAKE_COMMAND}" -G Ninja -S "${SOURCE}/../../Examples/cpp_client" -B "${consumer}/client"
    "-DDspace_ROOT=${PREFIX}" -DCMAKE_BUILD_TYPE=Debug)
  step("${CMAKE_COMMAND}" --build "${consumer}/client")
  step("${PYTHON}" -W ignore "${SOURCE}/client.py" "${consumer}/client/drive")
  message(STATUS "${output}")
  unset(ENV{PYTHONPATH}) # the command finds the package beside itself
  step("${PREFIX}/bin/dspace" terrain info "${data}/../field/field.tif")
  if(NOT output MATCHES "1001 x 1001 pixels of Float32")
    message(FATAL_ERROR "dspace terrain info printed: ${output}")
  endif()
endif()
