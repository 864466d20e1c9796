// A table of a TOML file that people write (board files, timing vectors), read by key. Every mistake is a UsageError of
// one line: file, line, key, what was found, what was expected.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <toml++/toml.h>

namespace brick {

toml::table parse_toml(const std::string& text, const std::string& path);

class TomlTable {
 public:
  // Only keys of `known` may stand in it. The table must outlive this object.
  TomlTable(std::string path, const toml::table& table, const std::vector<std::string>& known);

  bool has(const std::string& key) const { return table_->get(key) != nullptr; }
  const toml::node& need(const std::string& key) const;
  std::string text(const std::string& key) const;
  std::vector<std::string> texts(const std::string& key) const;
  std::string text_in(const std::string& key, const toml::node& item) const;  // an item of the list `key`
  bool flag(const std::string& key) const;                                    // false where it is missing
  std::int64_t integer(const std::string& key, std::int64_t low, std::int64_t high, const std::string& expected) const;
  double real(const std::string& key, double low, double high, const std::string& expected) const;  // an integer too
  const toml::array& array(const std::string& key) const;
  // The table `key`, or an item of the list `key`, with the keys that it may have.
  TomlTable table(const std::string& key, const toml::node& item, const std::vector<std::string>& known) const;
  const toml::table& entries() const { return *table_; }

  const std::string& path() const { return path_; }
  static int line(const toml::node& node) { return static_cast<int>(node.source().begin.line); }
  [[noreturn]] void fail(const toml::node& at, const std::string& key, const std::string& expected) const;

 private:
  std::string path_;
  const toml::table* table_;
};

}  // namespace brick
