# Compiles every shaders/*/*.{vert,frag,comp} to SPIR-V (glslang for Vulkan 1.2, then spirv-opt: lavapipe takes seconds to
# compile unoptimised SPIR-V) and embeds all of them in the program as engine/gpu's shader table.
find_program(GLSLANG glslangValidator REQUIRED)
find_program(SPIRV_OPT spirv-opt REQUIRED)
file(GLOB shader_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/shaders/*/*.vert ${CMAKE_SOURCE_DIR}/shaders/*/*.frag ${CMAKE_SOURCE_DIR}/shaders/*/*.comp)
set(shader_dir ${CMAKE_BINARY_DIR}/shaders)
file(MAKE_DIRECTORY ${shader_dir})
set(spirv_files)
set(full_files)
set(names)
set(assembly "")
foreach(source ${shader_sources})
  get_filename_component(name ${source} NAME)
  set(spirv ${shader_dir}/${name}.spv)
  # The unoptimised twin holds all that the source declares, and names for the tests; the optimised one is shipped.
  add_custom_command(OUTPUT ${shader_dir}/${name}.full.spv ${spirv}
    COMMAND ${GLSLANG} --target-env vulkan1.2 -g -Od --quiet -I${CMAKE_SOURCE_DIR}/shaders -I${CMAKE_SOURCE_DIR}/shaders/shared ${source} --depfile ${shader_dir}/${name}.d -o ${shader_dir}/${name}.full.spv
    COMMAND ${SPIRV_OPT} -O --strip-debug ${shader_dir}/${name}.full.spv -o ${spirv}
    DEPENDS ${source} DEPFILE ${shader_dir}/${name}.d COMMENT "Compiling shader ${name}" VERBATIM)
  list(APPEND spirv_files ${spirv})
  list(APPEND full_files ${shader_dir}/${name}.full.spv)
  list(APPEND names ${name})
  string(MAKE_C_IDENTIFIER ${name} id)
  string(APPEND assembly ".balign 16\n.global skerry_shader_${id}\nskerry_shader_${id}:\n.incbin \"${spirv}\"\n.global skerry_shader_${id}_end\nskerry_shader_${id}_end:\n")
endforeach()

# What passes must bind is what the sources declare: a pass that binds something else does not compile (engine/gpu/graph/bindings.h), and
# the build ends with a source that declares what it does not use.
add_executable(skerry_shader_table ${CMAKE_SOURCE_DIR}/tools/shader_table/main.cpp ${CMAKE_SOURCE_DIR}/engine/gpu/program/reflection.cpp)
target_link_libraries(skerry_shader_table PRIVATE skerry_options)
set(generated ${CMAKE_BINARY_DIR}/generated)
set(shader_table ${generated}/shader_table.cpp ${generated}/shader_names.h)
add_custom_command(OUTPUT ${shader_table}
  COMMAND skerry_shader_table ${generated} ${shader_dir} ${names}
  DEPENDS skerry_shader_table ${full_files} COMMENT "Listing what shaders declare" VERBATIM)

enable_language(ASM)
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/shader_blob.S CONTENT ".section .rodata\n${assembly}.section .note.GNU-stack,\"\",%progbits\n" @ONLY)
set_source_files_properties(${CMAKE_BINARY_DIR}/generated/shader_blob.S PROPERTIES OBJECT_DEPENDS "${spirv_files}")
add_library(skerry_shaders STATIC ${CMAKE_BINARY_DIR}/generated/shader_blob.S ${shader_table})
target_link_libraries(skerry_shaders PUBLIC skerry_options)
target_link_libraries(skerry_gpu PUBLIC skerry_shaders)
