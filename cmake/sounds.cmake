# Builds skerry_sounds, lets it synthesise all sounds, and embeds the file in the program for game/sound.
file(GLOB synthesis_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tools/sounds/*.cpp)
list(REMOVE_ITEM synthesis_sources ${CMAKE_SOURCE_DIR}/tools/sounds/main.cpp)
add_library(skerry_synthesis STATIC ${synthesis_sources})
target_link_libraries(skerry_synthesis PUBLIC skerry_options skerry_core)
add_executable(skerry_sounds ${CMAKE_SOURCE_DIR}/tools/sounds/main.cpp)
target_link_libraries(skerry_sounds PRIVATE skerry_synthesis)

set(sounds_file ${CMAKE_BINARY_DIR}/generated/sound_bank.bin)
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/sound_bank.S CONTENT
".section .rodata
.balign 16
.global skerry_sound_bank
skerry_sound_bank:
.incbin \"${sounds_file}\"
.global skerry_sound_bank_end
skerry_sound_bank_end:
.section .note.GNU-stack,\"\",%progbits
" @ONLY)
add_custom_command(OUTPUT ${sounds_file}
  COMMAND skerry_sounds ${sounds_file}
  DEPENDS skerry_sounds COMMENT "Synthesising sounds" VERBATIM)
set_source_files_properties(${CMAKE_BINARY_DIR}/generated/sound_bank.S PROPERTIES OBJECT_DEPENDS ${sounds_file})
add_library(skerry_sound_bank STATIC ${CMAKE_BINARY_DIR}/generated/sound_bank.S ${sounds_file})
target_link_libraries(skerry_game PUBLIC skerry_sound_bank)

# The tests listen to what the synthesis returns. skerry_tests is defined later.
cmake_language(DEFER CALL target_link_libraries skerry_tests PRIVATE skerry_synthesis)
