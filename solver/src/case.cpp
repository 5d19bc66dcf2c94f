#include "crossdem/case.hpp"

#include <cmath>
#include <numbers>

#include "case_reader.hpp"
#include "case_writer.hpp"
#include "contradictions.hpp"

namespace crossdem {
namespace {

std::string joined(const std::vector<std::string>& faults) {
  std::string text;
  for (const std::string& fault : faults) text += (text.empty() ? "" : "\n") + fault;
  return text;
}

constexpr int deepest_nesting = 32;  // far above the schema's; what is nested without end cannot be shown in a message
constexpr std::size_t shown_of_key = 64;  // bytes, as long as a name may be

/// nlohmann::json silently keeps the last of two equal keys; a case must not depend on that. What is nested too deeply
/// is a CaseError at once.
class DuplicateKeys {
 public:
  bool operator()(int depth, nlohmann::json::parse_event_t event, const nlohmann::json& parsed) {
    using Event = nlohmann::json::parse_event_t;
    if (depth > deepest_nesting)
      throw CaseError({"nested more than " + std::to_string(deepest_nesting) + " levels deep: no case is"});
    if (event == Event::object_start) open_.emplace_back();
    if (event == Event::key) {
      open_.back().current = parsed.get<std::string>();
      if (!open_.back().keys.insert(open_.back().current).second) found.push_back(path() + ": the key stands twice");
    }
    if (event == Event::object_end) open_.pop_back();
    return true;
  }
  std::vector<std::string> found;

 private:
  struct Object {
    std::set<std::string> keys;
    std::string current;
  };

  [[nodiscard]] std::string path() const {
    std::string text;
    for (const Object& object : open_) {
      const bool whole = object.current.size() <= shown_of_key;
      text += (text.empty() ? "" : ".") + (whole ? object.current : object.current.substr(0, shown_of_key) + "...");
    }
    return text;
  }

  std::vector<Object> open_;
};

}  // namespace

CaseError::CaseError(std::vector<std::string> faults)
    : std::runtime_error(joined(faults)), faults_(std::move(faults)) {}

long TimeControl::steps_in(double interval) const { return std::lround(interval / step); }

double Case::disc_mass(double radius) const {
  return particles.density * std::numbers::pi * radius * radius * container.thickness;
}

Case read_case(std::string_view json) {
  DuplicateKeys duplicates;
  nlohmann::json root;
  try {
    root = nlohmann::json::parse(json, std::ref(duplicates));
  } catch (const nlohmann::json::exception& error) {
    throw CaseError({"not valid JSON: " + std::string(error.what())});
  }
  Case c;
  schema::Reader reader(root);
  reader.whole([&] { schema::root(reader, c); });
  std::vector<std::string> faults = std::move(duplicates.found);
  faults.insert(faults.end(), reader.faults().begin(), reader.faults().end());
  if (reader.complete()) {
    const std::vector<std::string> more = contradictions(c);
    faults.insert(faults.end(), more.begin(), more.end());
  }
  if (!faults.empty()) throw CaseError(std::move(faults));
  return c;
}

std::string canonical_json(const Case& resolved) {
  Case copy = resolved;  // the schema describes members by reference, for readers and writers alike
  nlohmann::json root;
  schema::Writer writer(root);
  schema::root(writer, copy);
  return root.dump();
}

}  // namespace crossdem
