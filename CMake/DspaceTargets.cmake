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

# ccache, where it is installed. Precompiled headers contain time stamps, which ccache must ignore (CCACHE_SLOPPINESS).
# By default ccache compares preprocessed sources, and the preprocessor may read an old precompiled header instead of
# the changed headers. With CCACHE_DEPEND it compares the compiler's list of dependencies.
find_program(DSPACE_CCACHE ccache)
if(DSPACE_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_DEPEND=true
    CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime "${DSPACE_CCACHE}")
endif()

# Several sources are compiled as one (a unity build): headers are parsed once for all of them. GCC then takes
# a source for a header, where a member whose type is in an anonymous namespace would be a mistake.
option(DSPACE_UNITY "Compile the sources of a library in groups" ON)

add_library(DspaceOptions INTERFACE)
# -ffp-contract=off: the same numbers whether or not the compiler finds a fused multiply-add.
target_compile_options(DspaceOptions INTERFACE -Wall -Wextra -Werror -ffp-contract=off)
if(DSPACE_UNITY)
  target_compile_options(DspaceOptions INTERFACE -Wno-subobject-linkage)
endif()
if(DSPACE_SANITIZE)
  # The checks of null pointers and alignment at every access take a third of the compile time. They are off: the
  # address sanitizer reports null pointers too, and the supported processors can read unaligned numbers.
  target_compile_options(DspaceOptions INTERFACE -fsanitize=address,undefined -fno-sanitize=null,alignment
    -fno-sanitize-recover=undefined -fno-omit-frame-pointer -Og -g1)
  # With the address sanitizer Eigen would store a pointer in front of each array. The test programs of the release build
  # free arrays that these libraries allocate, so that both must use malloc() directly.
  target_compile_options(DspaceOptions INTERFACE -DEIGEN_MALLOC_ALREADY_ALIGNED=1)
  # The release build's test programs run with these libraries. A library calls its own copies of inline
  # functions, which are instrumented, and not those of the program.
  target_link_options(DspaceOptions INTERFACE -fsanitize=address,undefined -Wl,-Bsymbolic-functions)
endif()

# dspace_options(TARGET): the same for a target that is exported (DspaceOptions itself is not).
function(dspace_options target)
  target_compile_options(${target} PRIVATE
    $<TARGET_PROPERTY:DspaceOptions,INTERFACE_COMPILE_OPTIONS>)
  target_link_options(${target} PRIVATE $<TARGET_PROPERTY:DspaceOptions,INTERFACE_LINK_OPTIONS>)
endfunction()

# dspace_rooms(VARIABLE ROOT ROOM CLASS... [ROOM ROOM CLASS...]): sets VARIABLE to the sources
# ROOT/ROOM/CLASS.cxx. The first word after each ROOM keyword is a folder; the others are class names.
# A unity build compiles the sources of a room together, at most eight at a time.
function(dspace_rooms variable root)
  set(sources)
  set(room)
  foreach(word IN LISTS ARGN)
    if(word STREQUAL "ROOM")
      set(room)
      set(count 0)
    elseif(NOT room)
      set(room "${root}/${word}")
      string(MAKE_C_IDENTIFIER "${word}" group)
    else()
      list(APPEND sources "${room}/${word}.cxx")
      math(EXPR part "${count} / 8")
      math(EXPR count "${count} + 1")
      set_source_files_properties("${room}/${word}.cxx" PROPERTIES UNITY_GROUP "${group}_${part}")
    endif()
  endforeach()
  set(${variable} "${sources}" PARENT_SCOPE)
endfunction()

# dspace_install_headers(ROOT ROOM CLASS... [ROOM ROOM CLASS...]): the public headers ROOT/ROOM/CLASS.h,
# installed under the path by which they are included.
function(dspace_install_headers root)
  set(room)
  foreach(word IN LISTS ARGN)
    if(word STREQUAL "ROOM")
      set(room)
    elseif(NOT room)
      set(room "${root}/${word}")
    else()
      install(FILES "${room}/${word}.h" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/${room}")
    endif()
  endforeach()
endfunction()

# dspace_unity(TARGET): compiles the sources of each room together, where DSPACE_UNITY is on.
function(dspace_unity target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${DSPACE_UNITY} UNITY_BUILD_MODE GROUP)
endfunction()

# dspace_plain_library(NAME SOURCES ... PUBLIC ... PRIVATE ...): plain C++, no VTK, no OpenGL.
# Its headers are <dspace/...>, relative to the folder of the library's CMakeLists.txt.
function(dspace_plain_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(${name} SHARED ${arg_SOURCES})
  add_library(Dspace::${name} ALIAS ${name})
  target_include_directories(${name} PUBLIC
    "$<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}>" "$<BUILD_INTERFACE:${CMAKE_CURRENT_BINARY_DIR}>"
    "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>")
  target_link_libraries(${name} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  dspace_options(${name})
  dspace_unity(${name})
  set_target_properties(${name} PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR})
  install(TARGETS ${name} EXPORT Dspace LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
endfunction()

# The environment in which every test runs.
set(DSPACE_TEST_ENVIRONMENT
  "DISPLAY=;DSPACE_SHIPPED_DATA=${CMAKE_SOURCE_DIR}/Data;ASAN_OPTIONS=detect_leaks=0;XDG_CACHE_HOME=${CMAKE_BINARY_DIR}/Testing/cache")

# dspace_tests(PROGRAM [GRAPHICS | WINDOWS] SOURCES ... [HEADERS ... | HEADERS_OF PROGRAM] [LIBS ...]): one GoogleTest program. ctest
# lists one test for each source Test*.cxx, by the source's name, and runs each in a process of its own.
# GRAPHICS: the tests need an OpenGL context; they run without a display, and fail at errors that
# OpenGL reports. WINDOWS: they need a display, and have one of their own. HEADERS are precompiled, or those
# of another program are used, which has the same options.
# Tests find real data through DSPACE_DATA, and skip where it is absent; data that ship through
# DSPACE_SHIPPED_DATA.
function(dspace_tests program)
  cmake_parse_arguments(arg "GRAPHICS;WINDOWS" "HEADERS_OF" "SOURCES;HEADERS;LIBS" ${ARGN})
  if(NOT DSPACE_TESTS)
    return()
  endif()
  add_executable(${program} EXCLUDE_FROM_ALL ${arg_SOURCES})
  add_dependencies(dspace_tests ${program})
  target_include_directories(${program} PRIVATE "${CMAKE_SOURCE_DIR}/Testing/Support")
  foreach(source IN LISTS arg_SOURCES)
    get_filename_component(folder "${CMAKE_CURRENT_SOURCE_DIR}/${source}" DIRECTORY)
    target_include_directories(${program} PRIVATE "${folder}") # for the support headers beside it
    # Most of the time goes into headers: eight sources of a folder are compiled together, or four.
    string(MAKE_C_IDENTIFIER "${folder}" room)
    set(together 8)
    if(folder MATCHES "/(frames|scene|layers)$") # whose helpers share names
      set(together 4)
    endif()
    math(EXPR part "0${count_${room}} / ${together}")
    math(EXPR count_${room} "0${count_${room}} + 1")
    set_source_files_properties("${source}" PROPERTIES UNITY_GROUP "${program}_${room}_${part}")
  endforeach()
  dspace_unity(${program})
  target_link_libraries(${program} PRIVATE ${arg_LIBS} DspaceOptions GTest::gtest GTest::gtest_main)
  # Compiling the tests costs more than running them: -O1 takes half the time of -O3.
  target_compile_options(${program} PRIVATE $<$<CONFIG:Release>:-O1>)
  if(arg_HEADERS_OF)
    target_precompile_headers(${program} REUSE_FROM ${arg_HEADERS_OF})
  else()
    target_precompile_headers(${program} PRIVATE <Eigen/Geometry> <gtest/gtest.h> ${arg_HEADERS})
  endif()
  set(environment "${DSPACE_TEST_ENVIRONMENT}")
  set(start)
  if(arg_GRAPHICS)
    set(label graphics)
    list(APPEND environment "DSPACE_OPENGL_DEBUG=1") # dspace/render/DebugOutput.h
  elseif(arg_WINDOWS)
    set(label windows)
    set(start "${CMAKE_SOURCE_DIR}/Testing/Tools/with_display")
  else()
    set(label plain)
  endif()
  set(listed)
  foreach(source IN LISTS arg_SOURCES)
    get_filename_component(name "${source}" NAME_WE)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/${source}")
    file(STRINGS "${source}" lines REGEX "^TEST(_F|_P)?\\(")
    set(filter)
    foreach(line IN LISTS lines)
      string(REGEX MATCH "^TEST(_F|_P)?\\( *([A-Za-z0-9_]+), *([A-Za-z0-9_]+)" found "${line}")
      set(case "${CMAKE_MATCH_2}.${CMAKE_MATCH_3}")
      if(CMAKE_MATCH_1 STREQUAL "_P")
        set(case "*/${case}/*")
      endif()
      list(APPEND filter "${case}")
    endforeach()
    list(APPEND listed ${filter})
    string(REPLACE ";" ":" filter "${filter}")
    add_test(NAME ${name} COMMAND ${start} $<TARGET_FILE:${program}> "--gtest_filter=${filter}")
    set_tests_properties(${name} PROPERTIES LABELS ${label} TIMEOUT 600
      ENVIRONMENT "${environment}")
  endforeach()
  # No case is left out: without all that are listed above, none remains.
  string(REPLACE ";" ":" listed "${listed}")
  add_test(NAME ${program}.listed COMMAND ${start} $<TARGET_FILE:${program}> "--gtest_filter=-${listed}")
  set_tests_properties(${program}.listed PROPERTIES LABELS ${label} TIMEOUT 60
    ENVIRONMENT "${environment}" PASS_REGULAR_EXPRESSION "Running 0 tests")
endfunction()
