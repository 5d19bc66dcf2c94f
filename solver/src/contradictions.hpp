#pragma once
#include <string>
#include <vector>

#include "crossdem/case.hpp"

namespace crossdem {

/// What no single key can say: faults between keys that were each read without fault, each "key.path: message".
std::vector<std::string> contradictions(const Case& c);

/// A number as messages show it.
std::string short_text(double value);

}  // namespace crossdem
