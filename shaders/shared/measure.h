// What `skerry bench device` times. docs/lavapipe.md.
#ifndef SKERRY_SHARED_MEASURE_H
#define SKERRY_SHARED_MEASURE_H
#include "types.h"

SHARED_BEGIN
// Bindings, of its programs alone.
SHARED_CONST uint kWordsBinding = 80u;         // words, as a storage buffer
SHARED_CONST uint kUniformWordsBinding = 81u;  // the same, as a uniform buffer
SHARED_CONST uint kTexelWordsBinding = 82u;    // the same, as texels of four
SHARED_CONST uint kImageWordsBinding = 83u;    // the same, as an image
SHARED_CONST uint kFilteredBinding = 84u;      // an image that is filtered
SHARED_CONST uint kSumsBinding = 85u;          // what is computed, so that nothing is left out

// Specialization constants, of its programs alone.
SHARED_CONST uint kGroupXConstant = 90u, kGroupYConstant = 91u, kGroupZConstant = 92u;
SHARED_CONST uint kWorkConstant = 93u;  // one of the below

// What each invocation does kMeasuredSteps times.
SHARED_CONST uint kWorkArithmetic = 0u;     // eight steps of four chains
SHARED_CONST uint kWorkStorage = 1u;        // a load from an address of its own
SHARED_CONST uint kWorkUniform = 2u;        // the same from a uniform buffer
SHARED_CONST uint kWorkTexels = 3u;         // from a texel buffer of 128 bits
SHARED_CONST uint kWorkImage = 4u;          // from an image
SHARED_CONST uint kWorkStorageOne = 5u;     // from a storage buffer, all from one address
SHARED_CONST uint kWorkUniformOne = 6u;     // from a uniform buffer, all from one address
SHARED_CONST uint kWorkFilter = 7u;         // a filtered texture
SHARED_CONST uint kWorkBranchBoth = 8u;     // arithmetic in both sides, neighbours differ
SHARED_CONST uint kWorkBranchOne = 9u;      // the same, all take one side
SHARED_CONST uint kWorkBranchNone = 10u;    // arithmetic that no invocation comes to
SHARED_CONST uint kWorkExitOwn = 11u;       // arithmetic in a loop, left after 1 to 16 rounds
SHARED_CONST uint kWorkExitEarly = 12u;     // the same, all after one
SHARED_CONST uint kWorkExitNever = 13u;     // the same, all after 16
SHARED_CONST uint kWorkExitUnrolled = 14u;  // as kWorkExitEarly, of at most 16 rounds
SHARED_CONST uint kWorkIndex = 15u;         // only what finds the address of a load

SHARED_CONST uint kMeasuredSteps = 16u;
SHARED_CONST uint kMeasuredWords = 4096u;       // a power of two
SHARED_CONST uint kMeasuredImageEdge = 64u;     // texels, squared kMeasuredWords
SHARED_CONST uint kMeasuredQuadsAcross = 224u;  // of the picture
SHARED_END
#endif
