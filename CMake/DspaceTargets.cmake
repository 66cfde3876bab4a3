# What every target of Dspace shares: language level, warnings, sanitizers, tests.
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
# The VTK modules too: Python loads several of them, and each class must exist once.
set(BUILD_SHARED_LIBS ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR}")
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_BINDIR}")
set(CMAKE_INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

find_program(DSPACE_CCACHE ccache)
if(DSPACE_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${DSPACE_CCACHE}")
  # Precompiled headers carry time stamps that ccache would otherwise take for changes.
  set(ENV{CCACHE_SLOPPINESS} "pch_defines,time_macros,include_file_mtime,include_file_ctime")
endif()

add_library(DspaceOptions INTERFACE)
# -ffp-contract=off: the same numbers whether or not the compiler finds a fused multiply-add.
target_compile_options(DspaceOptions INTERFACE -Wall -Wextra -Werror -ffp-contract=off)
if(DSPACE_SANITIZE)
  target_compile_options(DspaceOptions INTERFACE
    -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer -Og -g1)
  target_link_options(DspaceOptions INTERFACE -fsanitize=address,undefined)
endif()

# dspace_options(TARGET): the same for a target that is exported (DspaceOptions itself is not).
function(dspace_options target)
  target_compile_options(${target} PRIVATE
    $<TARGET_PROPERTY:DspaceOptions,INTERFACE_COMPILE_OPTIONS>)
  target_link_options(${target} PRIVATE $<TARGET_PROPERTY:DspaceOptions,INTERFACE_LINK_OPTIONS>)
endfunction()

# dspace_plain_library(NAME SOURCES ... PUBLIC ... PRIVATE ...): plain C++, no VTK, no OpenGL.
# Its headers stand under <dspace/...> beside its sources.
function(dspace_plain_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;HEADERS;PUBLIC;PRIVATE" ${ARGN})
  add_library(${name} SHARED ${arg_SOURCES})
  add_library(Dspace::${name} ALIAS ${name})
  target_include_directories(${name} PUBLIC
    "$<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}>" "$<BUILD_INTERFACE:${CMAKE_CURRENT_BINARY_DIR}>"
    "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>")
  target_link_libraries(${name} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  dspace_options(${name})
  set_target_properties(${name} PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR})
  install(TARGETS ${name} EXPORT Dspace LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  foreach(header IN LISTS arg_HEADERS)
    get_filename_component(dir "${header}" DIRECTORY)
    install(FILES "${header}" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/${dir}")
  endforeach()
endfunction()

# dspace_test(NAME [GRAPHICS] SOURCES ... LIBS ...): one GoogleTest program, one ctest entry.
# GRAPHICS: needs an OpenGL context; runs with no display. Real data is found through DSPACE_DATA,
# what ships through DSPACE_SHIPPED_DATA; a test skips, saying so, where the former is absent.
function(dspace_test name)
  cmake_parse_arguments(arg "GRAPHICS" "" "SOURCES;LIBS" ${ARGN})
  if(NOT DSPACE_TESTS)
    return()
  endif()
  add_executable(${name} ${arg_SOURCES})
  target_include_directories(${name} PRIVATE "${CMAKE_SOURCE_DIR}/Testing/Support")
  target_link_libraries(${name} PRIVATE ${arg_LIBS} DspaceOptions GTest::gtest GTest::gtest_main)
  add_test(NAME ${name} COMMAND ${name})
  if(arg_GRAPHICS)
    set(label graphics)
  else()
    set(label plain)
  endif()
  set_tests_properties(${name} PROPERTIES LABELS ${label} TIMEOUT 600
    ENVIRONMENT "DISPLAY=;DSPACE_SHIPPED_DATA=${CMAKE_SOURCE_DIR}/Data;ASAN_OPTIONS=detect_leaks=0;XDG_CACHE_HOME=${CMAKE_BINARY_DIR}/Testing/cache")
endfunction()

# dspace_shared_headers(FIRST HEADERS ... TESTS ...): FIRST's headers, precompiled once, for programs that
# are compiled alike.
function(dspace_shared_headers first)
  cmake_parse_arguments(arg "" "" "HEADERS;TESTS" ${ARGN})
  if(DSPACE_TESTS)
    target_precompile_headers(${first} PRIVATE ${arg_HEADERS})
    foreach(test IN LISTS arg_TESTS)
      target_precompile_headers(${test} REUSE_FROM ${first})
    endforeach()
  endif()
endfunction()
