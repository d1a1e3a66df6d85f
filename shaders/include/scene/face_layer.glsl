// Which layer of the block textures a face shows.
#ifndef SKERRY_FACE_LAYER_GLSL
#define SKERRY_FACE_LAYER_GLSL
#include "shared/bindings.h"
#include "shared/geometry.h"

// Material[], of which one word is loaded: three, of which one is then selected, cost lavapipe three times as much.
layout(scalar, binding = kMaterialsBinding) uniform MaterialWords { uint words[kMaxMaterials * kMaterialWords]; } material_words;

uint face_layer(uint face, uint block) {
  return material_words.words[block * kMaterialWords + (face == 2u ? kLayerTopWord : face == 3u ? kLayerBottomWord : kLayerSideWord)];
}
#endif
