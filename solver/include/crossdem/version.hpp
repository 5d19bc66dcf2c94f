#pragma once
#include <string>

namespace crossdem {

/// "0.1.0".
std::string version();

/// The version, the compiler and the flags it was built with: what the bits of a checkpoint are of.
std::string build_line();

/// One line: program, version, compiler and the flags it was built with.
std::string version_line();

}  // namespace crossdem
