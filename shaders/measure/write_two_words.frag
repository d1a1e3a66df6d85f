#version 460
// Two words a pixel, each to its own image: `skerry bench device`. docs/conventions.md.
layout(location = 0) flat in uint in_word;
layout(location = 0) out uint out_word;
layout(location = 1) out uint out_other_word;

void main() {
  out_word = in_word;
  out_other_word = ~in_word;
}
