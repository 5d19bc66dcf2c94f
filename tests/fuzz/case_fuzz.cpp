// Any bytes in place of a case: they are refused by a CaseError, or read as a case that is written and read the same
// again.

#include <cstdint>
#include <cstdlib>

#include "crossdem/case.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const std::string canonical = crossdem::canonical_json(crossdem::read_case(text));
    if (crossdem::canonical_json(crossdem::read_case(canonical)) != canonical) std::abort();
  } catch (const crossdem::CaseError&) {
  }
  return 0;
}
