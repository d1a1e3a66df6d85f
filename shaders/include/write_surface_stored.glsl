// Body of write_surface_stored.frag and write_surface_both.frag.
#include "include/common.glsl"
#include "include/write_stored.glsl"

layout(location = 0) flat in uint in_surface;
layout(location = 0) out uint out_surface;

void main() {
  out_surface = in_surface;
  write_stored(in_surface);
}
