// Lets one header be C++ and GLSL at once. Every struct in shaders/shared uses GLSL scalar layout,
// which equals the C++ layout of these types; a test compares the offsets with the SPIR-V.
#ifndef SKERRY_SHARED_TYPES_H
#define SKERRY_SHARED_TYPES_H
#ifdef __cplusplus
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#define SHARED_BEGIN namespace skerry::shared {
#define SHARED_END }
#define SHARED_CONST inline constexpr
#define SHARED_FUNCTION inline constexpr
namespace skerry::shared {
using uint = std::uint32_t;
using glm::ivec3;
using glm::mat4;
using glm::uvec2;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
}  // namespace skerry::shared
#else
#define SHARED_BEGIN
#define SHARED_END
#define SHARED_CONST const
#define SHARED_FUNCTION
#endif
#endif
