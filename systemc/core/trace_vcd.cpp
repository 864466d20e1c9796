// Value change dump (IEEE 1364 clause 18) with the `string` variables that GTKWave reads as an extension.
#include <unistd.h>

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "systemc/core/trace_formats.h"
#include "systemc/core/trace_queue.h"

namespace brick {

namespace {

constexpr std::size_t kFileBuffer = 1 << 16;
constexpr std::size_t kCode = 5;  // longest identifier code of a 32-bit number

// Identifier codes are numbers to base 94 in the printable characters.
std::string code_of(Signals::Id id) {
  std::string code;
  for (++id; id != 0; id = (id - 1) / 94) code += static_cast<char>('!' + (id - 1) % 94);
  return code;
}

// White space ends a string value, so it is written as an octal escape, as GTKWave does.
std::string escaped(const std::string& text) {
  const auto plain = [](char c) { return c > ' ' && c < 0x7F && c != '\\'; };
  if (std::all_of(text.begin(), text.end(), plain)) return text;
  std::string out;
  for (const char c : text) {
    if (plain(c))
      out += c;
    else
      out += fmt::format("\\{:03o}", static_cast<unsigned char>(c));
  }
  return out;
}

class VcdWriter : public TraceQueue {
 public:
  VcdWriter(const std::string& file, TimeFs from, TimeFs to)
      : TraceQueue(from, to), name_(file), file_(std::fopen(file.c_str(), "w")) {
    if (!file_) throw std::runtime_error(file + ": cannot write the waveform: " + std::strerror(errno));
    std::setvbuf(file_.get(), nullptr, _IONBF, 0);  // it gets pieces of 64 KiB
  }
  ~VcdWriter() override {
    try {
      close();
    } catch (const std::exception& e) { fmt::print(stderr, "{}\n", e.what()); }
  }

 private:
  void write_header(const TraceScope& top) override {
    for (Signals::Id id = 0; id < declared().size(); ++id) codes_.push_back(code_of(id));
    out_ += "$version brick $end\n$timescale 1 ps $end\n";
    write_scope("brick", top);
    out_ += "$enddefinitions $end\n";
  }
  void write_scope(const std::string& name, const TraceScope& scope) {
    out_ += fmt::format("$scope module {} $end\n", name);
    for (const auto& [signal, id] : scope.signals) {
      const Signals::Info& info = declared()[id].info;
      const std::string& code = codes_[declared()[id].of];
      if (info.radix == Radix::kText)
        out_ += fmt::format("$var string 1 {} {} $end\n", code, signal);
      else if (info.radix == Radix::kReal)
        out_ += fmt::format("$var real 64 {} {} $end\n", code, signal);
      else if (info.width == 1)
        out_ += fmt::format("$var wire 1 {} {} $end\n", code, signal);
      else
        out_ += fmt::format("$var wire {} {} {} [{}:0] $end\n", info.width, code, signal, info.width - 1);
    }
    for (const auto& [child, sub] : scope.scopes) write_scope(child, sub);
    out_ += "$upscope $end\n";
  }
  void write_time(std::int64_t ps, bool first) override {
    if (dumping_) out_ += "$end\n";
    dumping_ = first;
    const fmt::format_int digits(ps);
    line_.assign(1, '#').append(digits.data(), digits.size()).push_back('\n');
    out_ += line_;
    if (first) out_ += "$dumpvars\n";
    if (out_.size() > kFileBuffer) write_out();
    reached_ps_ = ps;
  }
  void write_value(Signals::Id id, std::uint64_t value) override {
    const unsigned width = declared()[id].info.width;
    if (declared()[id].info.radix == Radix::kReal) {
      out_ += fmt::format("r{} {}\n", real_of(value), codes_[id]);
      return;
    }
    char line[1 + 64 + 1 + kCode + 1];
    char* end = line;
    if (width > 1) *end++ = 'b';
    for (unsigned i = width; i-- > 0;) *end++ = static_cast<char>('0' + ((value >> i) & 1));
    if (width > 1) *end++ = ' ';
    end = std::copy(codes_[id].begin(), codes_[id].end(), end);
    *end++ = '\n';
    out_.append(line, end);
  }
  void write_text(Signals::Id id, const std::string& text) override {
    line_.assign(1, 's').append(escaped(text)).append(1, ' ').append(codes_[id]).push_back('\n');
    out_ += line_;
  }
  void write_out() {
    if (std::fwrite(out_.data(), 1, out_.size(), file_.get()) != out_.size()) fail();
    whole_ += static_cast<off_t>(out_.size());
    whole_ps_ = reached_ps_;
    out_.clear();
  }
  void finish() override {
    if (dumping_) out_ += "$end\n";
    write_out();
    if (std::fclose(file_.release()) != 0) fail();
  }
  // What is there stays a waveform that a viewer reads: part of a line is taken back.
  [[noreturn]] void fail() const {
    const int error = errno;
    if (file_) (void)!ftruncate(fileno(file_.get()), whole_);
    throw std::runtime_error(fmt::format("{}: cannot write the waveform beyond {:.6f} ms: {}", name_,
                                         static_cast<double>(whole_ps_) * 1e-9, std::strerror(error)));
  }

  struct Closer {
    void operator()(std::FILE* f) const { std::fclose(f); }
  };
  std::string name_;
  std::unique_ptr<std::FILE, Closer> file_;
  std::vector<std::string> codes_;
  std::string out_, line_;
  bool dumping_ = false;
  off_t whole_ = 0;                             // bytes of the file in whole lines
  std::int64_t reached_ps_ = 0, whole_ps_ = 0;  // in out_, in the file
};

}  // namespace

std::unique_ptr<TraceWriter> open_vcd(const std::string& file, TimeFs from, TimeFs to) {
  return std::make_unique<VcdWriter>(file, from, to);
}

}  // namespace brick
