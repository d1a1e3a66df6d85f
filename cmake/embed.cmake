# Adds a library TARGET that holds a file between the symbols TARGET and TARGET_end. What makes the file is the caller's.
function(skerry_embed target file)
  set(source ${CMAKE_BINARY_DIR}/generated/${target}.S)
  file(CONFIGURE OUTPUT ${source} CONTENT
".section .rodata
.balign 16
.global ${target}
${target}:
.incbin \"${file}\"
.global ${target}_end
${target}_end:
.section .note.GNU-stack,\"\",%progbits
" @ONLY)
  set_source_files_properties(${source} PROPERTIES OBJECT_DEPENDS ${file})
  add_library(${target} STATIC ${source} ${file})
endfunction()
