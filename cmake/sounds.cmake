# Builds skerry_sounds, lets it synthesise all sounds, and embeds the file in the program for game/sound.
file(GLOB synthesis_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tools/sounds/*.cpp)
list(REMOVE_ITEM synthesis_sources ${CMAKE_SOURCE_DIR}/tools/sounds/main.cpp)
add_library(skerry_synthesis STATIC ${synthesis_sources})
target_link_libraries(skerry_synthesis PUBLIC skerry_options skerry_core)
add_executable(skerry_sounds ${CMAKE_SOURCE_DIR}/tools/sounds/main.cpp)
target_link_libraries(skerry_sounds PRIVATE skerry_synthesis)

set(sounds_file ${CMAKE_BINARY_DIR}/generated/sound_bank.bin)
add_custom_command(OUTPUT ${sounds_file}
  COMMAND skerry_sounds ${sounds_file}
  DEPENDS skerry_sounds COMMENT "Synthesising sounds" VERBATIM)
skerry_embed(skerry_sound_bank ${sounds_file})
target_link_libraries(skerry_game PUBLIC skerry_sound_bank)

# The tests listen to what the synthesis returns. skerry_tests is defined later.
cmake_language(DEFER CALL target_link_libraries skerry_tests PRIVATE skerry_synthesis)
