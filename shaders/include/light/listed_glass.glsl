// A surface of glass as list_glass.frag keeps it: which blocks it parts. Needs before the include: media.glsl, `materials`.
#ifndef SKERRY_LISTED_GLASS_GLSL
#define SKERRY_LISTED_GLASS_GLSL

// Of air and liquids none.
vec3 glass_extinction(uint block) { return materials[block].liquid != 0u ? vec3(0.0) : extinction(materials[block]); }

uint listed_glass(uint entered, uint left) { return entered | (left << 10); }
uint entered_glass(uint listed) { return listed & 0x3ffu; }
uint left_glass(uint listed) { return listed >> 10; }
#endif
