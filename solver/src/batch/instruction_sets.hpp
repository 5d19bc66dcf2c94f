#pragma once
// Highway compiles the kernels once for each of these sets of instructions, and chooses when the program starts.

// Vectors of arm64 whose length is not known here cannot be members of a struct: there it is Neon that is used.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
