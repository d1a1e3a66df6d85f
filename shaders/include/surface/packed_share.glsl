// A share of light, 0..1 a channel, in a word: roots, so that small ones keep their precision.
#ifndef SKERRY_PACKED_SHARE_GLSL
#define SKERRY_PACKED_SHARE_GLSL

const vec3 kShareSteps = vec3(2047.0, 2047.0, 1023.0);

uint packed_share(vec3 share) {
  uvec3 steps = uvec3(sqrt(clamp(share, 0.0, 1.0)) * kShareSteps + 0.5);
  return steps.x | (steps.y << 11) | (steps.z << 22);
}
vec3 unpacked_share(uint packed) {
  vec3 root = vec3(packed & 2047u, (packed >> 11) & 2047u, packed >> 22) / kShareSteps;
  return root * root;
}
#endif
