#pragma once
#include <string>

namespace crossdem {

/// "0.1.0".
std::string version();

/// One line: program, version, compiler and the flags it was built with.
std::string version_line();

}  // namespace crossdem
