# Compiles every shaders/*.{vert,frag,comp} to SPIR-V (glslang for Vulkan 1.2, then spirv-opt: lavapipe takes seconds to
# compile unoptimised SPIR-V) and embeds all of them in the program as engine/gpu's shader table.
find_program(GLSLANG glslangValidator REQUIRED)
find_program(SPIRV_OPT spirv-opt REQUIRED)
file(GLOB shader_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/shaders/*.vert ${CMAKE_SOURCE_DIR}/shaders/*.frag ${CMAKE_SOURCE_DIR}/shaders/*.comp)
set(shader_dir ${CMAKE_BINARY_DIR}/shaders)
file(MAKE_DIRECTORY ${shader_dir})
set(spirv_files)
set(table "")
set(assembly "")
foreach(source ${shader_sources})
  get_filename_component(name ${source} NAME)
  set(spirv ${shader_dir}/${name}.spv)
  # -g keeps names for the reflection test in an unoptimised twin; the shipped one is optimised.
  add_custom_command(OUTPUT ${shader_dir}/${name}.full.spv ${spirv}
    COMMAND ${GLSLANG} --target-env vulkan1.2 -g -Od --quiet -I${CMAKE_SOURCE_DIR}/shaders -I${CMAKE_SOURCE_DIR}/shaders/shared ${source} --depfile ${shader_dir}/${name}.d -o ${shader_dir}/${name}.full.spv
    COMMAND ${SPIRV_OPT} -O --strip-debug ${shader_dir}/${name}.full.spv -o ${spirv}
    DEPENDS ${source} DEPFILE ${shader_dir}/${name}.d COMMENT "Compiling shader ${name}" VERBATIM)
  list(APPEND spirv_files ${spirv})
  string(MAKE_C_IDENTIFIER ${name} id)
  string(APPEND assembly ".balign 16\n.global skerry_shader_${id}\nskerry_shader_${id}:\n.incbin \"${spirv}\"\n.global skerry_shader_${id}_end\nskerry_shader_${id}_end:\n")
  string(APPEND externs "extern const unsigned char skerry_shader_${id}[], skerry_shader_${id}_end[];\n")
  string(APPEND entries "  {\"${name}\", skerry_shader_${id}, skerry_shader_${id}_end},\n")
endforeach()
if(spirv_files)
  enable_language(ASM)
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/shader_blob.S CONTENT ".section .rodata\n${assembly}.section .note.GNU-stack,\"\",%progbits\n" @ONLY)
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/shader_table.cpp CONTENT
"// Generated: every compiled shader, embedded.
#include \"engine/gpu/program/shader_table.h\"
extern \"C\" {
${externs}}
namespace skerry::gpu {
static const EmbeddedShader kShaders[] = {
${entries}};
std::span<const EmbeddedShader> embedded_shaders() { return kShaders; }
}  // namespace skerry::gpu
" @ONLY)
  set_source_files_properties(${CMAKE_BINARY_DIR}/generated/shader_blob.S PROPERTIES OBJECT_DEPENDS "${spirv_files}")
  add_library(skerry_shaders STATIC ${CMAKE_BINARY_DIR}/generated/shader_blob.S ${CMAKE_BINARY_DIR}/generated/shader_table.cpp)
  target_link_libraries(skerry_shaders PUBLIC skerry_options)
  target_link_libraries(skerry_gpu PUBLIC skerry_shaders)
endif()
