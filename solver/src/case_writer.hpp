#pragma once
// Walks the schema and writes the case as JSON; nlohmann::json keeps keys sorted, which makes the text canonical.

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "case_schema.hpp"

namespace crossdem::schema {

class Writer {
 public:
  explicit Writer(nlohmann::json& root) : object_(&root) { root = nlohmann::json::object(); }

  void number(const char* key, double value, Range, double = 0.0) { (*object_)[key] = value; }
  /// Left out where it is off: a case of the paper's law stays the case it is, by whatever options there are.
  void option(const char* key, double value) {
    if (value != 0.0) (*object_)[key] = value;
  }
  void numbers(const char* key, const std::vector<double>& values, Range,
               const std::optional<std::vector<double>>& = std::nullopt) {
    (*object_)[key] = values;
  }
  void integer(const char* key, int value, int, int, std::optional<int> = std::nullopt) { (*object_)[key] = value; }
  void boolean(const char* key, bool value, bool) { (*object_)[key] = value; }
  void text(const char* key, const std::string& value, const std::string& = {}) { (*object_)[key] = value; }
  void identifier(const char* key, const std::string& value) { (*object_)[key] = value; }
  void one_of(const char* key, const std::string& value, std::span<const std::string_view>) { (*object_)[key] = value; }
  void version(const char* key, int value) { (*object_)[key] = value; }

  template <class Enum>
  void choice(const char* key, Enum value, Names<Enum> names) {
    for (const auto& [candidate, name] : names)
      if (candidate == value) (*object_)[key] = std::string(name);
  }

  template <class Body>
  void group(const std::string& key, Body body) {
    write_into((*object_)[key], body);
  }

  template <class Body>
  void optional_group(const std::string& key, Body body) {
    group(key, body);
  }

  template <class Part, class Body>
  void optional_part(const std::string& key, std::optional<Part>& part, Body body) {
    if (part) group(key, [&] { body(*part); });
  }

  template <class Value, class Body>
  void optional_map(const std::string& key, std::map<std::string, Value>& values, const std::map<std::string, Value>&,
                    Body body) {
    group(key, [&] {
      for (auto& entry : values) group(entry.first, [&] { body(entry.second); });
    });
  }

  template <class Value, class Body>
  void optional_list(const std::string& key, std::vector<Value>& values, Body body) {
    nlohmann::json list = nlohmann::json::array();
    for (Value& value : values) write_into(list.emplace_back(), [&] { body(value); });
    (*object_)[key] = std::move(list);
  }

 private:
  template <class Body>
  void write_into(nlohmann::json& table, Body body) {
    table = nlohmann::json::object();
    nlohmann::json* outer = std::exchange(object_, &table);
    body();
    object_ = outer;
  }

  nlohmann::json* object_;
};

}  // namespace crossdem::schema
