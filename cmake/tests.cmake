# Every tests/**/*_test.cpp becomes part of one program; ctest sees each gtest case. Slow or device-bound suites add their own entries.
enable_testing()
include(GoogleTest)
# A header rather than definitions on every command line: a compiler cache then serves any checkout.
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/test_paths.h CONTENT
"// Generated: where the sources and the build are.
#pragma once
#define SKERRY_SOURCE_DIR \"${CMAKE_SOURCE_DIR}\"
#define SKERRY_BINARY_DIR \"${CMAKE_BINARY_DIR}\"
" @ONLY)
file(GLOB_RECURSE test_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tests/*_test.cpp)
if(test_sources)
  add_executable(skerry_tests ${test_sources})
  target_link_libraries(skerry_tests PRIVATE skerry_commands GTest::gtest_main)
  # What takes their time is in what they test. Two thirds of the time to compile.
  target_compile_options(skerry_tests PRIVATE $<$<CONFIG:Release>:-O1>)
  # What most tests include: a third of the time to compile.
  target_precompile_headers(skerry_tests PRIVATE <gtest/gtest.h> <algorithm> <cmath> <filesystem> <fstream> <map> <numeric> <random>
    ${CMAKE_SOURCE_DIR}/tests/render/renderer_on_gpu.h ${CMAKE_SOURCE_DIR}/game/view/scene_view.h)
  # GCC 12 finds faults in std::string's own code once that is precompiled.
  target_compile_options(skerry_tests PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds -Wno-restrict -Wno-stringop-overflow>)
  # Nor is ccache asked, which reads the 250 MB of the precompiled headers each time: twice the time to compile.
  set_target_properties(skerry_tests PROPERTIES CXX_COMPILER_LAUNCHER "")
  gtest_discover_tests(skerry_tests DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 1200)
endif()

# What needs neither device nor window, alone: small enough to be built a second and a third time, under sanitizers.
file(GLOB_RECURSE cpu_test_sources CONFIGURE_DEPENDS
  ${CMAKE_SOURCE_DIR}/tests/core/*_test.cpp ${CMAKE_SOURCE_DIR}/tests/mesh/*_test.cpp ${CMAKE_SOURCE_DIR}/tests/world/*_test.cpp)
if(cpu_test_sources)
  add_executable(skerry_cpu_tests EXCLUDE_FROM_ALL ${cpu_test_sources})
  target_link_libraries(skerry_cpu_tests PRIVATE skerry_world GTest::gtest_main)
endif()

# The program with its commands under the address and undefined-behaviour sanitizers, and everything below them as the plain build has it:
# that builds in a third of the time which the whole program needs, and the sanitizers still watch all memory that the commands touch.
file(GLOB_RECURSE measure_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tools/measure/*.cpp)
add_executable(skerry_sanitized EXCLUDE_FROM_ALL ${CMAKE_SOURCE_DIR}/tools/skerry/main.cpp ${command_sources} ${measure_sources})
target_link_libraries(skerry_sanitized PRIVATE ${command_libraries})
target_compile_options(skerry_sanitized PRIVATE -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer -O1 -g1)
target_link_options(skerry_sanitized PRIVATE -fsanitize=address,undefined)
skerry_unity(skerry_sanitized)

# The parsers of what comes from outside, with what they need and no more: built under sanitizers.
set(fuzz_sources tests/fuzz/targets.cpp game/input/actions.cpp game/input/bindings_file.cpp game/input/hints.cpp game/pace/learnt_costs.cpp game/pace/quality_front.cpp game/openexr/panorama_answer.cpp game/panorama/radiance_hdr.cpp engine/render/sky/panorama.cpp game/scene_file/expectations.cpp game/scene_file/cloud_files.cpp game/scene_file/json_text.cpp game/scene_file/options.cpp game/scene_file/parse.cpp game/scene_file/scene_files.cpp game/scene_file/scene_contents.cpp game/scene_file/setting_values.cpp game/scene_file/setting_keys.cpp game/scene_file/settings.cpp game/scene_file/world_keys.cpp game/scene_file/light_keys.cpp game/scene_file/picture_keys.cpp game/scene_file/program_keys.cpp game/scene_file/sound_keys.cpp game/scene_file/play_keys.cpp game/session/journal.cpp game/words/words.cpp game/worlds/gallery.cpp game/scene_file/vdb_options.cpp engine/render/light/lights.cpp engine/platform/files.cpp engine/platform/image_file.cpp engine/platform/png_plain.cpp engine/platform/tar.cpp engine/platform/input.cpp tools/skerry/farm/plan.cpp tools/skerry/farm/record.cpp tools/skerry/compare/unpacked.cpp tools/skerry/test/hashes.cpp)
list(TRANSFORM fuzz_sources PREPEND ${CMAKE_SOURCE_DIR}/)
function(skerry_fuzz_program name main)
  add_executable(${name} EXCLUDE_FROM_ALL ${CMAKE_SOURCE_DIR}/tests/fuzz/${main} ${fuzz_sources})
  target_link_libraries(${name} PRIVATE skerry_world skerry_words_en skerry_words_de skerry_words_fr skerry_words_es skerry_words_ru skerry_words_zh skerry_words_ja nlohmann_json::nlohmann_json OpenSSL::Crypto PNG::PNG deflate::deflate LibArchive::LibArchive)
  skerry_unity(${name})
endfunction()
skerry_fuzz_program(skerry_fuzz_short mutate_main.cpp)
if(SKERRY_SANITIZE MATCHES fuzzer)  # Clang's
  skerry_fuzz_program(skerry_fuzz libfuzzer.cpp)
  target_link_options(skerry_fuzz PRIVATE -fsanitize=fuzzer)
endif()

# Some damaged .vdb files, by the program itself; the run of thousands is a command of its own.
if(SKERRY_OPENVDB)
  add_test(NAME vdb.mutants COMMAND ${CMAKE_SOURCE_DIR}/tests/vdb/mutants
    $<TARGET_FILE:skerry> $<TARGET_FILE:skerry_vdb_samples> --count 96)
  set_tests_properties(vdb.mutants PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 600 PROCESSORS 2)
endif()

# The rules of the tree itself.
add_test(NAME tools.check_includes COMMAND ${CMAKE_SOURCE_DIR}/tools/check_includes)
add_test(NAME tools.check_paths COMMAND ${CMAKE_SOURCE_DIR}/tools/check_paths)
add_test(NAME tools.check_scripts_test COMMAND ${CMAKE_SOURCE_DIR}/tests/tools/check_scripts_test.py)
add_test(NAME tools.install_packages_test COMMAND ${CMAKE_SOURCE_DIR}/tests/tools/install_packages_test.py)
add_test(NAME tools.check_format COMMAND ${CMAKE_SOURCE_DIR}/tools/check_format)
set_tests_properties(tools.check_format PROPERTIES SKIP_RETURN_CODE 77)

# What differs from main, or from the commit before; a whole look takes a quarter of an hour: tools/check_tidy --all.
add_test(NAME tools.check_tidy COMMAND ${CMAKE_SOURCE_DIR}/tools/check_tidy)
add_test(NAME tools.check_tidy_test COMMAND ${CMAKE_SOURCE_DIR}/tests/tools/check_tidy_test.py)
set_tests_properties(tools.check_tidy tools.check_tidy_test PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 1200)

# The program itself: tests/cli runs it, and a script plays in a window on a virtual display.
if(test_sources)
  add_dependencies(skerry_tests skerry)
endif()
# One window at a time, beside other tests and before them, so that none is left to run alone at the end.
function(window_test name)
  add_test(NAME window.${name} COMMAND ${CMAKE_SOURCE_DIR}/tests/window/${name}_test.sh $<TARGET_FILE:skerry> ${ARGN})
  set_tests_properties(window.${name} PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 900 RESOURCE_LOCK window COST 1000)
endfunction()
foreach(name play screens dig view loading map end frames quality)
  window_test(${name})
endforeach()
set_tests_properties(window.frames PROPERTIES RUN_SERIAL TRUE)  # it compares what the processor does with and without the focus
add_library(skerry_virtual_pad MODULE EXCLUDE_FROM_ALL ${CMAKE_SOURCE_DIR}/tests/window/virtual_pad.cpp)
target_link_libraries(skerry_virtual_pad PRIVATE skerry_options glfw)
if(test_sources)
  add_dependencies(skerry_tests skerry_virtual_pad)
endif()
window_test(pad $<TARGET_FILE:skerry_virtual_pad>)

# Pictures: tests/scenes against their references, in processes of its own; and what must not change a byte. build/image keeps what was drawn.
add_test(NAME image.scenes COMMAND skerry test ${CMAKE_SOURCE_DIR}/tests/scenes --validate
  --html ${CMAKE_BINARY_DIR}/image/scenes_report --junit ${CMAKE_BINARY_DIR}/image/scenes.xml)
set_tests_properties(image.scenes PROPERTIES TIMEOUT 600 PROCESSORS 2)
# What CMake itself says of a build without OpenVDB; tests/cli runs the program that such a build makes.
add_test(NAME build.without_openvdb COMMAND ${CMAKE_COMMAND} -S ${CMAKE_SOURCE_DIR} -B ${CMAKE_BINARY_DIR}/without_openvdb
  -G ${CMAKE_GENERATOR} -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER} -DCMAKE_C_COMPILER=${CMAKE_C_COMPILER} -DSKERRY_OPENVDB=OFF)
if(SKERRY_OPENVDB)
  add_test(NAME image.scenes_of_files COMMAND ${CMAKE_SOURCE_DIR}/tests/image/scenes_of_files_test.sh
    $<TARGET_FILE:skerry> ${CMAKE_BINARY_DIR}/image/scenes_of_files)
  set_tests_properties(image.scenes_of_files PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 300 PROCESSORS 2)
endif()
add_test(NAME image.same_bytes COMMAND ${CMAKE_SOURCE_DIR}/tests/image/same_bytes_test.py
  $<TARGET_FILE:skerry> ${CMAKE_BINARY_DIR}/image/same_bytes)
set_tests_properties(image.same_bytes PROPERTIES TIMEOUT 900)

# The package, made and unpacked.
add_test(NAME package.deb COMMAND ${CMAKE_SOURCE_DIR}/tests/package/package_test.sh ${CMAKE_BINARY_DIR})
set_tests_properties(package.deb PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 300)

# Extremes against their bounds, as the program itself runs them.
add_test(NAME stability.all COMMAND ${CMAKE_SOURCE_DIR}/tests/tools/stability_test.py
  $<TARGET_FILE:skerry> ${CMAKE_BINARY_DIR}/stability)
set_tests_properties(stability.all PROPERTIES TIMEOUT 1800)

# A few of the hostile command lines; tests/hostile/run without --count runs 2,000.
add_test(NAME cli.hostile COMMAND ${CMAKE_SOURCE_DIR}/tests/hostile/run $<TARGET_FILE:skerry> --count 60)
set_tests_properties(cli.hostile PROPERTIES TIMEOUT 900 PROCESSORS 2)
# The commands that write reports, on little; tools/sanitize runs the same under the sanitizers.
add_test(NAME tools.commands COMMAND ${CMAKE_SOURCE_DIR}/tests/tools/commands_test.py
  $<TARGET_FILE:skerry> ${CMAKE_BINARY_DIR}/commands)
set_tests_properties(tools.commands PROPERTIES TIMEOUT 300)
# The same commands in parts, as plan, run and merge; tests/tools/farm_test.py PROGRAM FOLDER 100 kills a hundred times.
add_test(NAME tools.farm COMMAND ${CMAKE_SOURCE_DIR}/tests/tools/farm_test.py $<TARGET_FILE:skerry> ${CMAKE_BINARY_DIR}/farm)
set_tests_properties(tools.farm PROPERTIES TIMEOUT 600)
# The same under Slurm, on nodes that this machine plays; skipped without Debian's slurm-wlm or without root.
add_test(NAME tools.slurm COMMAND ${CMAKE_SOURCE_DIR}/tests/slurm/slurm_test.py $<TARGET_FILE:skerry> ${CMAKE_BINARY_DIR}/slurm)
set_tests_properties(tools.slurm PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 300 PROCESSORS 2)

# The buttons of a test's page, and what they save.
add_test(NAME tools.decisions COMMAND ${CMAKE_SOURCE_DIR}/tests/tools/decisions_test.py $<TARGET_FILE:skerry> ${CMAKE_BINARY_DIR}/decisions)
set_tests_properties(tools.decisions PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 120)
add_test(NAME tools.decisions_browser COMMAND ${CMAKE_SOURCE_DIR}/tests/tools/decisions_browser_test.py $<TARGET_FILE:skerry> ${CMAKE_BINARY_DIR}/decisions_browser)
set_tests_properties(tools.decisions_browser PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 120)

# The commands of docs/examples.
add_test(NAME tools.examples COMMAND ${CMAKE_SOURCE_DIR}/tests/tools/examples_test.py $<TARGET_FILE:skerry> ${CMAKE_BINARY_DIR}/examples)
set_tests_properties(tools.examples PROPERTIES TIMEOUT 120)

# Each deliberate breakage of tests/mutation still fits the code; the run of all of them builds for a quarter of an hour and is no part of this.
add_test(NAME mutation.list COMMAND ${CMAKE_SOURCE_DIR}/tests/mutation/run --check)
add_test(NAME mutation.programs COMMAND ${CMAKE_SOURCE_DIR}/tests/mutation/programs_test.py)
add_test(NAME mutation.stability COMMAND ${CMAKE_SOURCE_DIR}/tests/mutation/stability --check)

# What takes long in one process begins early, beside many short ones.
set_tests_properties(stability.all tools.farm image.same_bytes PROPERTIES COST 500)

# Tests whose caches are folders of their own still share what Mesa has compiled with all other tests: without it, half of their time goes to
# the same programs, compiled again by each. window.loading is about empty caches.
set(driver_cache "$ENV{XDG_CACHE_HOME}")
if(NOT driver_cache)
  set(driver_cache "$ENV{HOME}/.cache")
endif()
set_tests_properties(window.play window.screens window.dig window.view window.map window.end window.frames window.quality window.pad package.deb
  tools.commands tools.farm tools.slurm tools.decisions tools.decisions_browser tools.examples
  PROPERTIES ENVIRONMENT "MESA_SHADER_CACHE_DIR=${driver_cache}")
