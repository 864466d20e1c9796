// Reads a vector file: TOML around a text of one statement a line.
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "systemc/core/usage_error.h"
#include "systemc/machine/toml_table.h"
#include "testbench/unit/vectors/statement.h"

namespace brick {
namespace {

class Reader {
 public:
  Reader(const std::string& text, const std::string& path)
      : root_(parse_toml(text, path)),
        file_(path, root_, {"title", "section", "number", "device", "board", "units", "steps", "negative", "wave"}) {
    vector_.path = path;
    vector_.name = std::filesystem::path(path).stem().string();
  }

  Vector read() {
    vector_.title = file_.text("title");
    vector_.section = file_.text("section");
    constexpr int kMostVectors = 1000;
    if (file_.has("number"))
      vector_.number = static_cast<int>(file_.integer("number", 1, kMostVectors, "the number of a check vector"));
    read_device();
    read_units();
    read_steps();
    for (const auto& node : file_.array("negative"))
      vector_.negatives.push_back(read_negative(
          file_.table("negative", node, {"name", "write", "read", "late", "stuck", "invert", "command", "instead"})));
    if (vector_.negatives.empty()) file_.fail(file_.need("negative"), "negative", "a fault with which it must fail");
    if (file_.has("wave")) read_wave(file_.table("wave", file_.need("wave"), {"signals", "windows", "arrows"}));
    return std::move(vector_);
  }

 private:
  // What `take` makes of a text of one line; a mistake in it gets file, line and key in front.
  template <class Take>
  auto taken_apart(const TomlTable& in, const std::string& key, const toml::node& node, Take take) const {
    try {
      Statement s(in.text_in(key, node), vector_, marks_);
      auto result = take(s);
      s.end();
      return result;
    } catch (const UsageError& e) {
      const std::string where = fmt::format("{}:{}: ", file_.path(), TomlTable::line(node));
      if (std::string(e.what()).rfind(where, 0) == 0) throw;
      throw UsageError(fmt::format("{}{}: {}", where, key, e.what()));
    }
  }
  template <class Take>
  auto taken_apart(const TomlTable& in, const std::string& key, Take take) const {
    return taken_apart(in, key, in.need(key), take);
  }

  void read_device() {
    vector_.device = file_.text("device");
    std::vector<std::string> names;
    for (const auto& kind : device_kinds()) names.push_back(kind.name);
    if (std::find(names.begin(), names.end(), vector_.device) == names.end())
      file_.fail(file_.need("device"), "device", fmt::format("{}", fmt::join(names, " or ")));
    vector_.signals = vector_.kind().signals;
    for (unsigned n = 1; vector_.kind().encoders && n <= 4; ++n)
      vector_.signals.push_back({fmt::format("ch{}.position", n), false});
    if (vector_.kind().words > 0) vector_.signals.push_back({"bus", false});
    if (vector_.kind().commands) vector_.board = file_.text("board");
  }

  void read_units() {
    if (!file_.has("units")) return;
    const toml::node& units = file_.need("units");
    if (!units.is_table()) file_.fail(units, "units", "a table, as { sclk = 12 }");
    for (const auto& [key, node] : *units.as_table()) {
      const auto ticks = node.value_exact<std::int64_t>();
      if (!ticks || *ticks <= 0) file_.fail(node, std::string(key.str()), "a number of ticks");
      vector_.units[std::string(key.str())] = *ticks;
    }
  }

  void read_steps() {
    std::istringstream lines(file_.text("steps"));
    const toml::node& node = file_.need("steps");
    const auto source = node.source();
    int number = static_cast<int>(source.begin.line) + (source.end.line > source.begin.line ? 1 : 0);
    bool checked = false;
    for (std::string line; std::getline(lines, line); ++number) {
      try {
        auto step = parse_step(number, line, vector_, marks_);
        if (!step) continue;
        checked = checked || step->text.rfind("expect", 0) == 0 || step->text.find('=') != std::string::npos;
        vector_.steps.push_back(std::move(*step));
      } catch (const UsageError& e) { throw UsageError(fmt::format("{}:{}: {}", file_.path(), number, e.what())); }
    }
    if (!checked) file_.fail(node, "steps", "a line with 'expect', 'read' or a reply");
  }

  Corruption read_negative(const TomlTable& in) const {
    Corruption c{};
    c.name = in.text("name");
    const auto [key, kind] = only_fault(in);
    c.kind = kind;
    if (kind == Corruption::kCommand) {
      c.line = in.text("command");
      c.instead = in.text("instead");
      return c;
    }
    return taken_apart(in, key, [&, kind = kind](Statement& s) {
      if (kind == Corruption::kWrite || kind == Corruption::kRead) {
        c.word = s.register_word();
        s.expect("^");
        c.bits = s.bits24();
      } else if (kind == Corruption::kInvert) {
        c.signal = s.input();
      } else {
        c.signal = s.signal();
        s.expect(kind == Corruption::kLate ? "by" : "at");
        if (kind == Corruption::kLate) c.ticks = s.duration();
        if (kind == Corruption::kStuck) c.bits = static_cast<std::uint32_t>(s.expression());
      }
      return c;
    });
  }
  std::pair<std::string, Corruption::Kind> only_fault(const TomlTable& in) const {
    static const std::array<std::pair<std::string, Corruption::Kind>, 6> kKinds{{{"write", Corruption::kWrite},
                                                                                 {"read", Corruption::kRead},
                                                                                 {"late", Corruption::kLate},
                                                                                 {"stuck", Corruption::kStuck},
                                                                                 {"invert", Corruption::kInvert},
                                                                                 {"command", Corruption::kCommand}}};
    const auto there = [&](const auto& kind) { return in.has(kind.first); };
    if (std::count_if(kKinds.begin(), kKinds.end(), there) != 1)
      in.fail(in.entries(), "negative", "one fault: write, read, late, stuck, invert or command");
    return *std::find_if(kKinds.begin(), kKinds.end(), there);
  }

  void read_wave(const TomlTable& in) {
    Wave wave;
    for (const auto& node : in.array("signals"))
      wave.signals.push_back(taken_apart(in, "signals", node, [](Statement& s) { return s.signal(); }));
    for (const auto& node : in.array("windows")) {
      wave.windows.push_back(taken_apart(in, "windows", node, [&](Statement& s) {
        WaveWindow w{TomlTable::line(node), s.window(), 0};
        s.expect("step");
        w.step = s.duration();
        return w;
      }));
      if (wave.windows.back().step <= 0) in.fail(node, "windows", "a step of one tick or more");
    }
    if (wave.signals.empty()) in.fail(in.need("signals"), "signals", "one signal or more");
    if (wave.windows.empty()) in.fail(in.need("windows"), "windows", "one window or more");
    if (in.has("arrows"))
      for (const auto& node : in.array("arrows")) {
        const TomlTable arrow = in.table("arrows", node, {"from", "to", "after", "text"});
        const auto edge = [](Statement& s) { return s.signal_edge(); };
        wave.arrows.push_back({TomlTable::line(node), taken_apart(arrow, "from", edge), taken_apart(arrow, "to", edge),
                               taken_apart(arrow, "after", [](Statement& s) { return s.time_point(); }),
                               arrow.text("text")});
      }
    vector_.wave = std::move(wave);
  }

  toml::table root_;
  TomlTable file_;
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
  if (!file) throw UsageError(path + ": cannot be read; expected a timing vector");
  return parse_vector({std::istreambuf_iterator<char>(file), {}}, path);
}

}  // namespace brick
