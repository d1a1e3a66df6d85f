# skerry_openvdb, the one program that links OpenVDB: world/vdb/worker.h runs it, beside itself, as a confined child process.
if(NOT SKERRY_OPENVDB)
  return()
endif()

# Debian's package brings a FindOpenVDB, and with it a FindTBB and others that would shadow those in use here.
block(SCOPE_FOR VARIABLES)
  list(APPEND CMAKE_MODULE_PATH /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB)
  find_package(OpenVDB 9 QUIET)
  if(NOT OpenVDB_FOUND)
    message(FATAL_ERROR "OpenVDB is missing: install libopenvdb-dev and libboost-iostreams-dev, or configure with -DSKERRY_OPENVDB=OFF")
  endif()
endblock()

file(GLOB openvdb_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/world/vdb/openvdb_*.cpp)
add_executable(skerry_openvdb ${openvdb_sources} ${CMAKE_SOURCE_DIR}/world/vdb/answer.cpp
               ${CMAKE_SOURCE_DIR}/world/confined/answer_text.cpp ${CMAKE_SOURCE_DIR}/world/confined/child.cpp ${CMAKE_SOURCE_DIR}/world/confined/jail.cpp)
target_link_libraries(skerry_openvdb PRIVATE skerry_options skerry_core glm::glm OpenVDB::openvdb)
# Half the time to compile; reading and writing spend theirs in OpenVDB's library.
target_compile_options(skerry_openvdb PRIVATE $<$<CONFIG:Release>:-O1>)

# One file knows whether there is that program; a definition for all would compile the whole tree anew.
set_source_files_properties(${CMAKE_SOURCE_DIR}/world/vdb/has_openvdb.cpp PROPERTIES COMPILE_DEFINITIONS SKERRY_HAS_OPENVDB)
# Whatever reads volumes needs it beside itself; these targets are defined later.
cmake_language(DEFER CALL add_dependencies skerry skerry_openvdb)
cmake_language(DEFER CALL add_dependencies skerry_cpu_tests skerry_openvdb)

# Files as other programs write them, for the tests.
add_executable(skerry_vdb_samples EXCLUDE_FROM_ALL ${CMAKE_SOURCE_DIR}/tests/world/vdb/samples.cpp)
target_link_libraries(skerry_vdb_samples PRIVATE skerry_options OpenVDB::openvdb)
target_compile_options(skerry_vdb_samples PRIVATE -O0)  # runs for a moment, and would compile for minutes
cmake_language(DEFER CALL add_dependencies skerry_tests skerry_vdb_samples)
cmake_language(DEFER CALL add_dependencies skerry_cpu_tests skerry_vdb_samples)
# The program as a build without OpenVDB has it; such a build tests its own.
add_executable(skerry_without_openvdb EXCLUDE_FROM_ALL ${CMAKE_SOURCE_DIR}/tools/skerry/main.cpp ${CMAKE_SOURCE_DIR}/tests/cli/without_openvdb.cpp)
cmake_language(DEFER CALL target_link_libraries skerry_without_openvdb PRIVATE skerry_commands)
cmake_language(DEFER CALL add_dependencies skerry_tests skerry_without_openvdb)

# OpenVDB's templates take many minutes to compile under sanitizers, which are there for our parsers; main keeps them, as it must know of them.
if(SKERRY_SANITIZE)
  set_source_files_properties(${CMAKE_SOURCE_DIR}/world/vdb/openvdb_read.cpp ${CMAKE_SOURCE_DIR}/world/vdb/openvdb_write.cpp
                              PROPERTIES COMPILE_OPTIONS -fno-sanitize=all)
  set_source_files_properties(${CMAKE_SOURCE_DIR}/tests/world/vdb/samples.cpp PROPERTIES COMPILE_OPTIONS "-fno-sanitize=all;-O0")
endif()
