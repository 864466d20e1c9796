#include "app/regress/picture.h"

#include <fstapi.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <memory>
#include <vector>

#include <fmt/format.h>

namespace brick::regress {

namespace {

// Pixels.
constexpr int kLeft = 230, kWave = 900, kRight = 40, kRow = 20, kTop = 24, kHigh = 4, kLow = 16;
constexpr int kCharacter = 7, kLeastBox = 4;
constexpr double kPsPerMs = 1e9;
constexpr double kMostMarks = 10;  // of the axis

// Flags of GTKWave's save files.
constexpr unsigned long kHex = 0x2, kSigned = 0x400, kComment = 0x200, kGroupEnd = 0x1000000;

struct Change {
  std::uint64_t ps;
  std::string value;
};

struct Signal {
  unsigned width = 0;  // bits; 0: text or a number
  std::vector<Change> changes;
};

struct Row {
  std::string name;
  bool heading = false;
  unsigned long flags = 0;
};

std::vector<Row> rows_of(const std::string& view) {
  std::ifstream file(view);
  std::vector<Row> rows;
  unsigned long flags = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '[' || line[0] == '*') continue;
    if (line[0] == '@')
      flags = std::strtoul(line.c_str() + 1, nullptr, 16);
    else if (line[0] != '-')
      rows.push_back({line, false, flags});
    else if ((flags & kComment) != 0 && (flags & kGroupEnd) == 0)
      rows.push_back({line.substr(1), true, flags});
  }
  return rows;
}

class Wave {
 public:
  Wave(const std::string& file, const std::vector<Row>& rows) : context_(fstReaderOpen(file.c_str())) {
    if (!context_) return;
    for (const Row& row : rows) signals_[row.name];
    find_handles();
    fstReaderIterBlocksSetNativeDoublesOnCallback(context_.get(), 1);
    fstReaderIterBlocks2(context_.get(), take, take_text, this, nullptr);
    begin_ = fstReaderGetStartTime(context_.get());
    end_ = std::max(fstReaderGetEndTime(context_.get()), begin_ + 1);
  }
  std::uint64_t begin() const { return begin_; }
  std::uint64_t end() const { return end_; }
  // Nullptr where the waveform has none of that name.
  const Signal* find(const std::string& name) const {
    const auto at = signals_.find(name);
    return at == signals_.end() || at->second.changes.empty() ? nullptr : &at->second;
  }

 private:
  void find_handles() {
    std::vector<std::string> scopes;
    fstReaderClrFacProcessMaskAll(context_.get());
    while (const fstHier* item = fstReaderIterateHier(context_.get())) {
      if (item->htyp == FST_HT_SCOPE) scopes.emplace_back(item->u.scope.name);
      if (item->htyp == FST_HT_UPSCOPE) scopes.pop_back();
      if (item->htyp != FST_HT_VAR) continue;
      std::string name;
      for (const std::string& scope : scopes) name += scope + '.';
      for (const char* c = item->u.var.name; *c != 0; ++c)
        if (*c != ' ') name += *c;  // "count [23:0]"
      const auto at = signals_.find(name);
      if (at == signals_.end()) continue;
      if (item->u.var.typ == FST_VT_VCD_WIRE) at->second.width = item->u.var.length;
      by_handle_[item->u.var.handle].push_back(&at->second);
      fstReaderSetFacProcessMask(context_.get(), item->u.var.handle);
    }
  }

  void add(std::uint64_t ps, fstHandle handle, const std::string& value) {
    for (Signal* signal : by_handle_[handle])
      if (signal->changes.empty() || signal->changes.back().value != value) signal->changes.push_back({ps, value});
  }
  static void take(void* self, std::uint64_t ps, fstHandle handle, const unsigned char* value) {
    Wave& wave = *static_cast<Wave*>(self);
    const auto& signals = wave.by_handle_[handle];
    if (signals.empty()) return;
    double number = 0;
    if (signals[0]->width != 0) {
      wave.add(ps, handle, reinterpret_cast<const char*>(value));
    } else {
      std::memcpy(&number, value, sizeof number);
      wave.add(ps, handle, fmt::format("{:g}", number));
    }
  }
  static void take_text(void* self, std::uint64_t ps, fstHandle handle, const unsigned char* value,
                        std::uint32_t size) {
    static_cast<Wave*>(self)->add(ps, handle, {reinterpret_cast<const char*>(value), size});
  }

  struct Close {
    void operator()(void* context) const { fstReaderClose(context); }
  };
  std::unique_ptr<void, Close> context_;
  std::map<std::string, Signal> signals_;
  std::map<fstHandle, std::vector<Signal*>> by_handle_;
  std::uint64_t begin_ = 0, end_ = 1;
};

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text)
    if (c == '<' || c == '&')
      safe += fmt::format("&#{};", static_cast<int>(c));
    else if (static_cast<unsigned char>(c) >= ' ' && static_cast<unsigned char>(c) < 0x7f)
      safe += c;
  return safe;
}

// Bits as the view shows them; what is no number stays.
std::string shown(const std::string& bits, const Signal& signal, unsigned long flags) {
  if (signal.width == 0 || signal.width > 64 || bits.find_first_not_of("01") != std::string::npos) return bits;
  const std::uint64_t value = std::strtoull(bits.c_str(), nullptr, 2);
  if ((flags & kHex) != 0) return fmt::format("{:0{}X}", value, (signal.width + 3) / 4);
  if ((flags & kSigned) == 0 || bits[0] == '0') return std::to_string(value);
  return fmt::format("-{}", (signal.width == 64 ? 0 : std::uint64_t{1} << signal.width) - value);
}

class Picture {
 public:
  Picture(const Wave& wave, double at_ms) : wave_(wave), at_ms_(at_ms) {}

  void add(const Row& row) {
    const Signal* signal = row.heading ? nullptr : wave_.find(row.name);
    if (!row.heading && signal == nullptr) return;
    if (row.heading) {  // shown with its first signal
      heading_ = row.name;
      return;
    }
    if (!heading_.empty()) {
      body_ += fmt::format("<text x=\"6\" y=\"{}\" font-weight=\"bold\">{}</text>\n", y_ + kLow - 2, escaped(heading_));
      y_ += kRow;
      heading_.clear();
    }
    body_ += fmt::format("<text x=\"14\" y=\"{}\">{}</text>\n", y_ + kLow - 2,
                         escaped(row.name.substr(row.name.find('.') + 1)));
    if (signal->width == 1)
      add_line(*signal);
    else
      add_boxes(*signal, row.flags);
    y_ += kRow;
  }

  std::string svg() const {
    if (y_ == kTop) return "";
    std::string text = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
        "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        kLeft + kWave + kRight, y_ + kRow / 2);
    const double step = step_of_axis();
    for (double ms = std::ceil(static_cast<double>(wave_.begin()) / kPsPerMs / step) * step;
         ms * kPsPerMs <= static_cast<double>(wave_.end()); ms += step) {
      const int at = x(static_cast<std::uint64_t>(ms * kPsPerMs));
      text += fmt::format(
          "<path d=\"M{0} {1}V{2}\" stroke=\"#ddd\"/><text x=\"{0}\" y=\"14\" text-anchor=\"middle\" "
          "fill=\"#555\">{3:g} ms</text>\n",
          at, kTop - 4, y_, ms);
    }
    const int failed = x(static_cast<std::uint64_t>(at_ms_ * kPsPerMs));
    return text + body_ +
           fmt::format("<path d=\"M{} {}V{}\" stroke=\"#c4302b\" stroke-width=\"1.5\"/>\n</svg>\n", failed, kTop - 4,
                       y_);
  }

 private:
  int x(std::uint64_t ps) const {
    const double part = static_cast<double>(std::clamp(ps, wave_.begin(), wave_.end()) - wave_.begin()) /
                        static_cast<double>(wave_.end() - wave_.begin());
    return kLeft + static_cast<int>(std::lround(part * kWave));
  }

  // 1, 2 or 5 times a power of ten.
  double step_of_axis() const {
    const double least = static_cast<double>(wave_.end() - wave_.begin()) / kPsPerMs / kMostMarks;
    const double power = std::pow(10, std::floor(std::log10(least)));
    for (const double times : {1.0, 2.0, 5.0})
      if (times * power >= least) return times * power;
    return 10 * power;
  }

  // One pixel shows at most that the signal was both.
  void add_line(const Signal& signal) {
    const auto level = [this](const std::string& value) { return y_ + (value == "1" ? kHigh : kLow); };
    int at = x(signal.changes[0].ps), now = level(signal.changes[0].value), turns = 0;
    std::string path = fmt::format("M{} {}", at, now);
    int drawn = now;
    for (std::size_t i = 1; i < signal.changes.size(); ++i) {
      const int to = x(signal.changes[i].ps);
      if (to != at) {
        if (drawn != now) path += fmt::format("V{}", now);
        path += fmt::format("H{}", to);
        drawn = now;
        turns = 0;
      }
      at = to;
      now = level(signal.changes[i].value);
      if (turns++ < 2) path += fmt::format("V{}", drawn = now);
    }
    if (drawn != now) path += fmt::format("V{}", now);
    body_ += fmt::format("<path d=\"{}H{}\" fill=\"none\" stroke=\"#1a6b3a\"/>\n", path, kLeft + kWave);
  }

  // Values that are too short to be seen stand together as a band.
  void add_boxes(const Signal& signal, unsigned long flags) {
    int band = -1;
    const auto end_band = [&](int to) {
      if (band >= 0)
        body_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"#9bb7d4\"/>\n", band,
                             y_ + kHigh, std::max(1, to - band), kLow - kHigh);
      band = -1;
    };
    for (std::size_t i = 0; i < signal.changes.size(); ++i) {
      const bool last = i + 1 == signal.changes.size();
      const int from = x(signal.changes[i].ps), to = last ? kLeft + kWave : x(signal.changes[i + 1].ps);
      if (to - from < kLeastBox && !last) {
        if (band < 0) band = from;
        continue;
      }
      end_band(from);
      body_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"#eef3f9\" stroke=\"#3a6ea5\"/>\n",
                           from, y_ + kHigh, std::max(1, to - from), kLow - kHigh);
      const std::string text = shown(signal.changes[i].value, signal, flags);
      if (static_cast<int>(text.size() + 1) * kCharacter <= to - from)
        body_ +=
            fmt::format("<text x=\"{}\" y=\"{}\" font-size=\"11\">{}</text>\n", from + 3, y_ + kLow - 2, escaped(text));
    }
  }

  const Wave& wave_;
  const double at_ms_;
  std::string body_, heading_;
  int y_ = kTop;
};

}  // namespace

std::string picture_of(const std::string& wave, const std::string& view, double at_ms) {
  const std::vector<Row> rows = rows_of(view);
  const Wave read(wave, rows);
  Picture picture(read, at_ms);
  for (const Row& row : rows) picture.add(row);
  return picture.svg();
}

}  // namespace brick::regress
