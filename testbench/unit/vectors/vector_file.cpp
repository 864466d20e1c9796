// Reads a vector file: TOML around a text of one statement a line.
#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "testbench/unit/vectors/statement.h"

namespace brick {
namespace {

class Reader {
 public:
  Reader(const std::string& text, const std::string& path) {
    vector_.path = path;
    vector_.name = std::filesystem::path(path).stem().string();
    try {
      root_ = toml::parse(text, path);
    } catch (const toml::parse_error& error) {
      throw VectorError(fmt::format("{}:{}: {}", path, error.source().begin.line, error.description()));
    }
  }

  Vector read() {
    known_keys(root_, {"title", "section", "number", "device", "board", "units", "steps", "negative", "wave"});
    vector_.title = text(root_, "title");
    vector_.section = text(root_, "section");
    if (root_.contains("number")) vector_.number = integer(root_, "number");
    read_device();
    read_units();
    read_steps();
    read_negatives();
    if (const auto* wave = table(root_, "wave")) read_wave(*wave);
    return std::move(vector_);
  }

 private:
  using Keys = std::initializer_list<std::string_view>;

  std::string at(const toml::node& node) const { return fmt::format("{}:{}", vector_.path, node.source().begin.line); }
  [[noreturn]] void missing(const toml::table& in, const std::string& what) const {
    throw VectorError(fmt::format("{}: found no {}, expected {}", at(in), what.substr(0, what.find(',')),
                                  what.substr(what.find(',') + 2)));
  }
  void known_keys(const toml::table& in, Keys keys) const {
    for (const auto& [key, node] : in) {
      const std::string_view name = key.str();
      if (std::find(keys.begin(), keys.end(), name) == keys.end())
        throw VectorError(
            fmt::format("{}: found the key '{}', expected one of {}", at(node), name, fmt::join(keys, ", ")));
    }
  }
  std::string text(const toml::table& in, const std::string& key) const {
    const toml::node* node = in.get(key);
    if (node == nullptr) missing(in, fmt::format("'{}', a text", key));
    return text(*node);
  }
  std::string text(const toml::node& node) const {
    if (!node.is_string()) throw VectorError(at(node) + ": found another type, expected a text in quotation marks");
    return **node.as_string();
  }
  int integer(const toml::table& in, const std::string& key) const {
    const toml::node& node = *in.get(key);
    if (!node.is_integer())
      throw VectorError(fmt::format("{}: found another type, expected an integer for '{}'", at(node), key));
    return static_cast<int>(**node.as_integer());
  }
  const toml::table* table(const toml::table& in, const std::string& key) const {
    const toml::node* node = in.get(key);
    if (node != nullptr && !node->is_table())
      throw VectorError(fmt::format("{}: found another type, expected the table '{}'", at(*node), key));
    return node == nullptr ? nullptr : node->as_table();
  }
  const toml::array& array(const toml::table& in, const std::string& key, const char* of) const {
    const toml::node* node = in.get(key);
    if (node == nullptr) missing(in, fmt::format("'{}', an array of {}", key, of));
    if (!node->is_array())
      throw VectorError(fmt::format("{}: found another type, expected an array of {} for '{}'", at(*node), of, key));
    return *node->as_array();
  }
  // A text of one line, to be taken apart.
  Statement statement(const toml::node& node) const { return {at(node), text(node), vector_, marks_}; }

  void read_device() {
    vector_.device = text(root_, "device");
    std::vector<std::string> names;
    for (const auto& kind : device_kinds()) names.push_back(kind.name);
    if (std::find(names.begin(), names.end(), vector_.device) == names.end()) {
      throw VectorError(fmt::format("{}: found the device '{}', expected {}", at(*root_.get("device")), vector_.device,
                                    fmt::join(names, " or ")));
    }
    vector_.signals = vector_.kind().signals;
    if (vector_.kind().words) {
      for (unsigned n = 1; n <= 4; ++n) vector_.signals.push_back({fmt::format("ch{}.position", n), false});
      vector_.signals.push_back({"bus", false});
    }
    if (vector_.kind().commands) vector_.board = text(root_, "board");
  }

  void read_units() {
    const auto* units = table(root_, "units");
    if (units == nullptr) return;
    for (const auto& [key, node] : *units) {
      if (!node.is_integer() || **node.as_integer() <= 0)
        throw VectorError(
            fmt::format("{}: found no number of ticks, expected one for the unit '{}'", at(node), key.str()));
      vector_.units[std::string(key.str())] = **node.as_integer();
    }
  }

  void read_steps() {
    std::istringstream lines(text(root_, "steps"));
    const toml::node& node = *root_.get("steps");
    int number =
        static_cast<int>(node.source().begin.line) + (node.source().end.line > node.source().begin.line ? 1 : 0);
    bool checked = false;
    for (std::string line; std::getline(lines, line); ++number) {
      auto step = parse_step(fmt::format("{}:{}", vector_.path, number), number, line, vector_, marks_);
      if (!step) continue;
      checked = checked || step->text.rfind("expect", 0) == 0 || step->text.find('=') != std::string::npos;
      vector_.steps.push_back(std::move(*step));
    }
    if (!checked)
      throw VectorError(at(node) +
                        ": found steps that expect nothing, expected a line with 'expect', 'read' or a reply");
  }

  void read_negatives() {
    for (const auto& node : array(root_, "negative", "tables, each a fault with which the vector must fail")) {
      if (!node.is_table()) throw VectorError(at(node) + ": found another type, expected a table [[negative]]");
      const auto& in = *node.as_table();
      known_keys(in, {"name", "write", "read", "late", "stuck", "invert", "command", "instead"});
      vector_.negatives.push_back(read_negative(in));
    }
    if (vector_.negatives.empty())
      throw VectorError(at(root_) + ": found no [[negative]], expected a fault with which the vector must fail");
  }
  Corruption read_negative(const toml::table& in) const {
    Corruption c{};
    c.name = text(in, "name");
    const auto& [kind, node] = only_fault(in);
    c.kind = kind;
    if (kind == Corruption::kCommand) {
      c.line = text(*node);
      c.instead = text(in, "instead");
      return c;
    }
    Statement s = statement(*node);
    if (kind == Corruption::kWrite || kind == Corruption::kRead) {
      c.word = s.word();
      s.expect("^");
      c.bits = s.bits24();
    } else {
      c.signal = kind == Corruption::kInvert ? s.input() : s.signal();
      if (kind == Corruption::kLate) {
        s.expect("by");
        c.ticks = s.duration();
      } else if (kind == Corruption::kStuck) {
        s.expect("at");
        c.bits = static_cast<std::uint32_t>(s.number());
      }
    }
    s.end();
    return c;
  }
  std::pair<Corruption::Kind, const toml::node*> only_fault(const toml::table& in) const {
    constexpr std::pair<const char*, Corruption::Kind> kinds[] = {
        {"write", Corruption::kWrite}, {"read", Corruption::kRead},     {"late", Corruption::kLate},
        {"stuck", Corruption::kStuck}, {"invert", Corruption::kInvert}, {"command", Corruption::kCommand}};
    std::pair<Corruption::Kind, const toml::node*> found{Corruption::kWrite, nullptr};
    unsigned faults = 0;
    for (const auto& [key, kind] : kinds) {
      if (const toml::node* node = in.get(key)) {
        found = {kind, node};
        ++faults;
      }
    }
    if (faults != 1)
      throw VectorError(fmt::format("{}: found {} faults, expected one: write, read, late, stuck, invert or command",
                                    at(in), faults));
    return found;
  }

  void read_wave(const toml::table& in) {
    known_keys(in, {"signals", "windows", "arrows"});
    Wave wave;
    for (const auto& node : array(in, "signals", "signal names")) {
      Statement s = statement(node);
      wave.signals.push_back(s.signal());
      s.end();
    }
    for (const auto& node : array(in, "windows", "windows")) {
      Statement s = statement(node);
      WaveWindow w{line(node), s.window(), 0};
      s.expect("step");
      w.step = s.duration();
      if (w.step <= 0) throw VectorError(at(node) + ": found a step of 0, expected at least one tick");
      s.end();
      wave.windows.push_back(std::move(w));
    }
    if (wave.signals.empty() || wave.windows.empty()) missing(in, "row or window, at least one signal and one window");
    if (in.contains("arrows"))
      for (const auto& node : array(in, "arrows", "tables")) wave.arrows.push_back(read_arrow(node));
    vector_.wave = std::move(wave);
  }
  WaveArrow read_arrow(const toml::node& node) const {
    if (!node.is_table()) throw VectorError(at(node) + ": found another type, expected { from, to, after, text }");
    const auto& in = *node.as_table();
    known_keys(in, {"from", "to", "after", "text"});
    for (const char* key : {"from", "to", "after", "text"}) text(in, key);
    Statement from = statement(*in.get("from")), to = statement(*in.get("to")), after = statement(*in.get("after"));
    WaveArrow arrow{line(node), from.signal_edge(), to.signal_edge(), after.time(), text(in, "text")};
    from.end();
    to.end();
    after.end();
    return arrow;
  }
  static int line(const toml::node& node) { return static_cast<int>(node.source().begin.line); }

  toml::table root_;
  Vector vector_;
  std::vector<std::string> marks_{"begin"};
};

}  // namespace

const DeviceKind& Vector::kind() const {
  return *std::find_if(device_kinds().begin(), device_kinds().end(),
                       [this](const auto& k) { return k.name == device; });
}

Vector parse_vector(const std::string& text, const std::string& path) { return Reader(text, path).read(); }

Vector read_vector(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw VectorError(path + ": cannot be read");
  std::ostringstream text;
  text << file.rdbuf();
  return parse_vector(text.str(), path);
}

}  // namespace brick
