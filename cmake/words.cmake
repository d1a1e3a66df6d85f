# Embeds what the screens say in each language for game/words.
foreach(language en de fr es ru zh ja)
  skerry_embed(skerry_words_${language} ${CMAKE_SOURCE_DIR}/game/words/${language}.txt)
  target_link_libraries(skerry_game PUBLIC skerry_words_${language})
endforeach()
