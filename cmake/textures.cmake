# Builds skerry_textures, lets it paint all block textures, and embeds the file in the program for engine/render.
file(GLOB painter_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tools/textures/*.cpp)
list(REMOVE_ITEM painter_sources ${CMAKE_SOURCE_DIR}/tools/textures/main.cpp)
add_library(skerry_painter STATIC ${painter_sources})
target_link_libraries(skerry_painter PUBLIC skerry_options skerry_core)
add_executable(skerry_textures ${CMAKE_SOURCE_DIR}/tools/textures/main.cpp)
target_link_libraries(skerry_textures PRIVATE skerry_painter)

enable_language(ASM)
set(textures_file ${CMAKE_BINARY_DIR}/generated/block_textures.bin)
add_custom_command(OUTPUT ${textures_file}
  COMMAND skerry_textures ${textures_file}
  DEPENDS skerry_textures COMMENT "Painting block textures" VERBATIM)
skerry_embed(skerry_block_textures ${textures_file})
target_link_libraries(skerry_render PUBLIC skerry_block_textures)

# The tests compare the painter's own words with what the program holds. skerry_tests is defined later.
cmake_language(DEFER CALL target_link_libraries skerry_tests PRIVATE skerry_painter)
