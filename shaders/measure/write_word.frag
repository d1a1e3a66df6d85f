#version 460
// One word a pixel: `skerry bench device`. docs/conventions.md.
layout(location = 0) flat in uint in_word;
layout(location = 0) out uint out_word;

void main() { out_word = in_word; }
