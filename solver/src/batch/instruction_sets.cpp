// What this machine has, and which of it the kernels use.

#include "instruction_sets.hpp"

#include <stdexcept>
#include <string>

#include "kernels.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "batch/instruction_sets.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace crossdem::batch::HWY_NAMESPACE {
std::string_view InstructionSet() { return hwy::TargetName(HWY_TARGET); }
}  // namespace crossdem::batch::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace crossdem::batch {
namespace {

HWY_EXPORT(InstructionSet);

/// Compiled, and to be had on this machine; a better one has a lower bit.
std::vector<std::int64_t> targets() {
  static const std::int64_t both = hwy::SupportedTargets() & HWY_TARGETS;
  std::vector<std::int64_t> found;
  for (std::int64_t left = both; left != 0; left &= left - 1) found.push_back(left & -left);
  return found;
}

}  // namespace

std::string_view instruction_set() { return HWY_DYNAMIC_DISPATCH(InstructionSet)(); }

std::vector<std::string_view> instruction_sets() {
  std::vector<std::string_view> names;
  for (const std::int64_t target : targets()) names.emplace_back(hwy::TargetName(target));
  return names;
}

void use_instruction_set(std::string_view name) {
  for (const std::int64_t target : targets()) {
    if (name != hwy::TargetName(target)) continue;
    hwy::GetChosenTarget().Update(target);
    return;
  }
  throw std::invalid_argument("no instruction set \"" + std::string(name) + "\" here");
}

}  // namespace crossdem::batch
#endif
