# skerry_openexr, the one program that links OpenEXR: game/openexr/read_exr.h runs it, beside itself, as a confined child process.
find_package(OpenEXR 3 REQUIRED)
add_executable(skerry_openexr ${CMAKE_SOURCE_DIR}/game/openexr/openexr_main.cpp ${CMAKE_SOURCE_DIR}/game/openexr/panorama_answer.cpp
               ${CMAKE_SOURCE_DIR}/engine/render/sky/panorama.cpp ${CMAKE_SOURCE_DIR}/world/confined/answer_text.cpp ${CMAKE_SOURCE_DIR}/world/confined/child.cpp
               ${CMAKE_SOURCE_DIR}/world/confined/jail.cpp)
target_link_libraries(skerry_openexr PRIVATE skerry_options skerry_core glm::glm OpenEXR::OpenEXR)
cmake_language(DEFER CALL add_dependencies skerry skerry_openexr)

# Files as other programs write them, for the tests.
add_executable(skerry_exr_samples EXCLUDE_FROM_ALL ${CMAKE_SOURCE_DIR}/tests/game/openexr/samples.cpp)
target_link_libraries(skerry_exr_samples PRIVATE skerry_options OpenEXR::OpenEXR)
cmake_language(DEFER CALL add_dependencies skerry_tests skerry_exr_samples)
