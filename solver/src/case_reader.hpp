#pragma once
// Walks the schema over JSON text and collects every fault by its key path.

#include <cmath>
#include <concepts>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "case_schema.hpp"

namespace crossdem::schema {

class Reader {
 public:
  explicit Reader(const nlohmann::json& root) : object_(&root) {}

  [[nodiscard]] const std::vector<std::string>& faults() const { return faults_; }
  /// True when every key that the schema knows was read; there may still be keys that it does not know.
  [[nodiscard]] bool complete() const { return faults_.size() == unknown_keys_; }
  void fault(const std::string& key, const std::string& message) {
    const std::string at = path(key);
    faults_.push_back(at.empty() ? message : at + ": " + message);
  }

  void number(const std::string& key, double& value, Range range, std::optional<double> fallback = std::nullopt) {
    if (const auto* entry = find(key, fallback.has_value())) {
      read_number(key, *entry, value, range);
    } else if (fallback) {
      value = *fallback;
    }
  }

  /// A number >= 0 beyond the paper's law, 0 where the case says nothing.
  void option(const std::string& key, double& value) { number(key, value, Range::non_negative, 0.0); }

  void numbers(const std::string& key, std::vector<double>& values, Range range,
               const std::optional<std::vector<double>>& fallback = std::nullopt) {
    const auto* entry = find(key, fallback.has_value());
    if (entry == nullptr) {
      if (fallback) values = *fallback;
      return;
    }
    if (!entry->is_array() || entry->empty()) return fault(key, "must be a list of numbers, is " + shown(*entry));
    values.assign(entry->size(), 0.0);
    for (std::size_t k = 0; k < values.size(); ++k)
      read_number(key + "[" + std::to_string(k) + "]", (*entry)[k], values[k], range);
  }

  void integer(const std::string& key, int& value, int lowest, int highest,
               std::optional<int> fallback = std::nullopt) {
    const auto* entry = find(key, fallback.has_value());
    if (entry == nullptr) {
      if (fallback) value = *fallback;
      return;
    }
    const auto within = [&](auto n) { return std::cmp_greater_equal(n, lowest) && std::cmp_less_equal(n, highest); };
    const bool good = entry->is_number_unsigned()  ? within(entry->get<std::uint64_t>())
                      : entry->is_number_integer() ? within(entry->get<std::int64_t>())
                                                   : false;
    if (!good) {
      return fault(key, "must be a whole number from " + std::to_string(lowest) + " to " + std::to_string(highest) +
                            ", is " + shown(*entry));
    }
    value = entry->get<int>();
  }

  void boolean(const std::string& key, bool& value, bool fallback) {
    value = fallback;
    const auto* entry = find(key, true);
    if (entry == nullptr) return;
    if (!entry->is_boolean()) return fault(key, "must be true or false, is " + shown(*entry));
    value = entry->get<bool>();
  }

  void text(const std::string& key, std::string& value, std::optional<std::string> fallback = std::nullopt) {
    const auto* entry = find(key, fallback.has_value());
    if (entry == nullptr) {
      if (fallback) value = *fallback;
      return;
    }
    if (!entry->is_string() || entry->get_ref<const std::string&>().empty())
      return fault(key, "must be a text that is not empty, is " + shown(*entry));
    value = entry->get<std::string>();
  }

  /// A text that may name files and columns: letters, digits, underscores and inner dashes only.
  void identifier(const std::string& key, std::string& value) {
    const auto* entry = find(key, false);
    if (entry == nullptr) return;
    if (!entry->is_string() || !is_identifier(entry->get_ref<const std::string&>()))
      return fault(key, "must consist of 1 to 64 letters, digits, underscores and dashes, is " + shown(*entry));
    value = entry->get<std::string>();
  }

  void one_of(const std::string& key, std::string& value, std::span<const std::string_view> allowed) {
    value = *allowed.begin();
    const auto* entry = find(key, true);
    if (entry == nullptr) return;
    if (entry->is_string())
      for (const std::string_view name : allowed)
        if (entry->get_ref<const std::string&>() == name) return void(value = name);
    fault(key, "must be " + listed(allowed) + ", is " + shown(*entry));
  }

  template <class Enum>
  void choice(const std::string& key, Enum& value, Names<Enum> names) {
    const auto* entry = find(key, true);
    if (entry == nullptr) return;
    std::vector<std::string_view> allowed;
    for (const auto& [candidate, name] : names) {
      if (entry->is_string() && entry->get_ref<const std::string&>() == name) return void(value = candidate);
      allowed.push_back(name);
    }
    fault(key, "must be " + listed(allowed) + ", is " + shown(*entry));
  }

  void version(const std::string& key, int understood) {
    const auto* entry = find(key, false);
    if (entry != nullptr && (!entry->is_number_integer() || *entry != understood))
      fault(key, "this crossdem reads version " + std::to_string(understood) + ", not " + shown(*entry));
  }

  template <std::invocable Body>
  void group(const std::string& key, Body body) {
    if (const auto* entry = find(key, false)) enter(key, *entry, body);
  }

  /// A table that may be left out: it is then read as if it were there and empty.
  template <std::invocable Body>
  void optional_group(const std::string& key, Body body) {
    static const nlohmann::json empty = nlohmann::json::object();
    const auto* entry = find(key, true);
    enter(key, entry != nullptr ? *entry : empty, body);
  }

  /// A table that may be left out: there is then none.
  template <class Part, std::invocable<Part&> Body>
  void optional_part(const std::string& key, std::optional<Part>& part, Body body) {
    const auto* entry = find(key, true);
    if (entry != nullptr) enter(key, *entry, [&] { body(part.emplace()); });
  }

  /// Entries of `fallbacks` that are not named are there all the same.
  template <class Value, std::invocable<Value&> Body>
  void optional_map(const std::string& key, std::map<std::string, Value>& values,
                    const std::map<std::string, Value>& fallbacks, Body body) {
    const auto* entry = find(key, true);
    if (entry == nullptr) return void(values = fallbacks);
    enter(key, *entry, [&] {
      for (const auto& item : entry->items()) {
        find(item.key(), true);
        if (!is_identifier(item.key()))
          fault(item.key(), "a name here must consist of 1 to 64 letters, digits, underscores and dashes");
        else
          enter(item.key(), item.value(), [&] { body(values[item.key()]); });
      }
    });
    values.insert(fallbacks.begin(), fallbacks.end());
  }

  template <class Value, std::invocable<Value&> Body>
  void optional_list(const std::string& key, std::vector<Value>& values, Body body) {
    const auto* entry = find(key, true);
    if (entry == nullptr) return;
    if (!entry->is_array()) return fault(key, "must be a list of tables ([[" + key + "]]), is " + shown(*entry));
    values.resize(entry->size());
    for (std::size_t k = 0; k < values.size(); ++k)
      enter(key + "[" + std::to_string(k) + "]", (*entry)[k], [&] { body(values[k]); });
  }

  /// Reads the whole object this reader was made for, then names the keys nothing asked for.
  template <std::invocable Body>
  void whole(Body body) {
    enter("", *object_, body);
  }

 private:
  static bool is_identifier(const std::string& text) {
    return !text.empty() && text.size() <= 64 && text.front() != '-' &&
           text.find_first_not_of(identifier_characters) == std::string::npos;
  }

  /// The value as the user wrote it, shortened.
  static std::string shown(const nlohmann::json& value) {
    std::string text = value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
    return text.size() > 60 ? text.substr(0, 57) + "..." : text;
  }

  template <class List>
  static std::string listed(const List& names) {
    std::string text;
    for (const std::string_view name : names) text += (text.empty() ? "" : ", ") + std::string(name);
    return names.size() > 1 ? "one of " + text : text;
  }

  [[nodiscard]] std::string path(const std::string& key) const {
    return prefix_.empty() || key.empty() ? prefix_ + key : prefix_ + "." + key;
  }

  const nlohmann::json* find(const std::string& key, bool optional) {
    known_.insert(key);
    const auto entry = object_->find(key);
    if (entry != object_->end()) return &*entry;
    if (!optional) fault(key, "missing");
    return nullptr;
  }

  void read_number(const std::string& key, const nlohmann::json& entry, double& value, Range range) {
    if (!entry.is_number()) return fault(key, "must be a finite number, is " + shown(entry));
    const auto number = entry.get<double>();
    if (range == Range::positive && !(number > 0.0)) return fault(key, "must be above 0, is " + shown(entry));
    if (range == Range::non_negative && !(number >= 0.0)) return fault(key, "must not be negative, is " + shown(entry));
    if (range == Range::share && !(number >= 0.0 && number <= 1.0))
      return fault(key, "must be from 0 to 1, is " + shown(entry));
    value = number;
  }

  template <class Body>
  void enter(const std::string& key, const nlohmann::json& table, Body body) {
    if (!table.is_object()) return fault(key, "must be a table, is " + shown(table));
    const std::string outer_prefix = std::exchange(prefix_, path(key));
    const nlohmann::json* outer_object = std::exchange(object_, &table);
    std::set<std::string> outer_known = std::exchange(known_, {});
    body();
    for (const auto& [name, value] : table.items()) {
      if (known_.contains(name)) continue;
      fault(name, "unknown key; known here: " + listed_known());
      ++unknown_keys_;
    }
    known_ = std::move(outer_known);
    object_ = outer_object;
    prefix_ = outer_prefix;
  }

  [[nodiscard]] std::string listed_known() const {
    std::string text;
    for (const std::string& name : known_) text += (text.empty() ? "" : ", ") + name;
    return text;
  }

  static constexpr const char* identifier_characters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";

  const nlohmann::json* object_;
  std::string prefix_;
  std::set<std::string> known_;
  std::vector<std::string> faults_;
  std::size_t unknown_keys_ = 0;
};

}  // namespace crossdem::schema
