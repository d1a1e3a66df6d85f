// Where water meets glass two faces lie in one plane. They are one surface, of the block that is entered: the other's back is not drawn.
#ifndef SKERRY_TOUCHED_GLSL
#define SKERRY_TOUCHED_GLSL

// @param touched as draw_quads.vert hands it on: a whole number, interpolated.
uint touched_number(float touched) { return uint(touched + 0.5); }
bool touches_another(float touched) { return touched_number(touched) != 0u; }
#endif
