// FST, the compressed format of GTKWave, through the C library that ships with Verilator.
#include <fstapi.h>

#include <fstream>
#include <stdexcept>

#include <fmt/format.h>

#include "systemc/core/fst_map.h"
#include "systemc/core/trace_formats.h"
#include "systemc/core/trace_queue.h"

namespace brick {

namespace {

constexpr int kPicoseconds = -12;

// The library says nothing about what it could not write. A file is blocks, each a byte of its kind and the length from
// there on; the names of signals are the last, and the end of the last is the end of the file.
bool is_whole(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  int kind = 0, last = FST_BL_SKIP;
  while ((kind = in.get()) != std::ifstream::traits_type::eof()) {
    unsigned char bytes[8];
    if (!in.read(reinterpret_cast<char*>(bytes), sizeof bytes)) return false;
    std::uint64_t length = 0;
    for (const unsigned char byte : bytes) length = length << 8 | byte;
    const auto rest = static_cast<std::streamoff>(length - sizeof bytes);
    if (rest > 0 && !(in.seekg(rest - 1, std::ios::cur) && in.get() != std::ifstream::traits_type::eof())) return false;
    last = kind;
  }
  return last == FST_BL_HIER || last == FST_BL_HIER_LZ4 || last == FST_BL_HIER_LZ4DUO;
}

class FstWriter : public TraceQueue {
 public:
  FstWriter(const std::string& file, TimeFs from, TimeFs to)
      : TraceQueue(from, to), name_(file), context_(fstWriterCreate(file.c_str(), 1)) {
    if (!context_) throw std::runtime_error(file + ": cannot write the waveform");
    fstWriterSetTimescale(context_.get(), kPicoseconds);
    fstWriterSetVersion(context_.get(), "brick");
    fstWriterSetPackType(context_.get(), FST_WR_PT_LZ4);
  }
  ~FstWriter() override {
    try {
      close();
    } catch (const std::exception& e) { fmt::print(stderr, "{}\n", e.what()); }
  }

 private:
  void write_header(const TraceScope& top) override {
    handles_.resize(declared().size());
    write_scope("brick", top);
  }
  void write_scope(const std::string& name, const TraceScope& scope) {
    fstWriterSetScope(context_.get(), FST_ST_VCD_MODULE, name.c_str(), nullptr);
    for (const auto& [signal, id] : scope.signals) {
      const Signals::Info& info = declared()[id].info;
      const bool text = info.radix == Radix::kText, real = info.radix == Radix::kReal;
      const std::string range = !text && !real && info.width > 1 ? " [" + std::to_string(info.width - 1) + ":0]" : "";
      fstHandle& handle = handles_[declared()[id].of];
      const fstHandle made =
          fstWriterCreateVar(context_.get(),
                             text   ? FST_VT_GEN_STRING
                             : real ? FST_VT_VCD_REAL
                                    : FST_VT_VCD_WIRE,
                             FST_VD_IMPLICIT, text ? 0 : info.width, (signal + range).c_str(), handle);
      if (handle == 0) handle = made;
    }
    for (const auto& [child, sub] : scope.scopes) write_scope(child, sub);
    fstWriterSetUpscope(context_.get());
  }
  void write_time(std::int64_t ps, bool) override {
    fstWriterEmitTimeChange(context_.get(), static_cast<std::uint64_t>(ps));
  }
  void write_value(Signals::Id id, std::uint64_t value) override {
    const unsigned width = declared()[id].info.width;
    if (declared()[id].info.radix == Radix::kReal) {
      fstWriterEmitValueChange(context_.get(), handles_[id], &value);  // takes the bits of a number
      return;
    }
    char bits[64];
    for (unsigned i = 0; i < width; ++i) bits[i] = static_cast<char>('0' + ((value >> (width - 1 - i)) & 1));
    fstWriterEmitValueChange(context_.get(), handles_[id], bits);
  }
  void write_text(Signals::Id id, const std::string& text) override {
    fstWriterEmitVariableLengthValueChange(context_.get(), handles_[id], text.data(),
                                           static_cast<std::uint32_t>(text.size()));
  }
  void finish() override {
    context_.reset();
    const bool parts_whole = take_short_fst_files() == 0;
    if (!parts_whole || !is_whole(name_))
      throw std::runtime_error(name_ + ": cannot write the waveform: no room for all of it");
  }

  struct Closer {
    void operator()(void* context) const { fstWriterClose(context); }
  };
  std::string name_;
  std::unique_ptr<void, Closer> context_;
  std::vector<fstHandle> handles_;
};

}  // namespace

std::unique_ptr<TraceWriter> open_fst(const std::string& file, TimeFs from, TimeFs to) {
  return std::make_unique<FstWriter>(file, from, to);
}

}  // namespace brick
