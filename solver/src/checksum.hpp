#pragma once
// Checksums of what lies in files, against accidents.

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cstdint>
#include <string_view>
#include <type_traits>
#include <vector>

namespace crossdem {

/// XXH3 of bytes that come piece by piece.
class Checksum {
 public:
  Checksum() { XXH3_64bits_reset(&state_); }

  void add(std::string_view bytes) { XXH3_64bits_update(&state_, bytes.data(), bytes.size()); }

  template <class Value>
  void add(const std::vector<Value>& values) {
    XXH3_64bits_update(&state_, values.data(), sizeof(Value) * values.size());
  }

  [[nodiscard]] std::uint64_t value() const { return XXH3_64bits_digest(&state_); }

 private:
  XXH3_state_t state_{};
};

}  // namespace crossdem
